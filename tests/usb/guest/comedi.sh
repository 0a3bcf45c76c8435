# SPDX-License-Identifier: GPL-3.0-or-later
# Recordings from the card that the kernel's module comedi_test emulates: input 0 is a sawtooth of 1 V and 0.1 s, input 1
# a square wave. WIRINGS is the folder of the wirings.
. "$GUEST/prelude.sh"
[ -c /dev/comedi0 ] || fail "comedi_test made no card"
cp "$WIRINGS"/*.json .
results=/guest/results

# take WIRING NAME TIME: what it prints is in NAME.out and NAME.err, its exit code in NAME.code.
take() {
  code=0
  timeout 200 "$TACTOGRAPH" record -d "comedi:$1" -o "$2" --time "$3" --json >$results/"$2".out 2>$results/"$2".err || code=$?
  echo $code >$results/"$2".code
}
at_work() { [ -e "$1.wav" ]; }

"$TACTOGRAPH" doctor -d comedi:saw --json >$results/doctor.json || true
take saw saw 2s
say "a rate that the driver changes"
take fast fast 200ms
say "the program is stopped until the card's buffer runs over; another program asks for the card"
"$TACTOGRAPH" record -d comedi:saw -o stopped --time 100s --json >$results/stopped.out 2>$results/stopped.err &
pid=$!
within 60 at_work stopped
sleep 2
take saw second 100ms
kill -STOP $pid
sleep 8
kill -CONT $pid
code=0
wait $pid || code=$?
echo $code >$results/stopped.code
say "a card that is not there"
take none none 100ms
cp saw.json saw.wav fast.json fast.wav stopped.json stopped.wav $results/
