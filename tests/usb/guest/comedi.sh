# SPDX-License-Identifier: GPL-3.0-or-later
# Recordings from, and a playback on, the card that the kernel's module comedi_test emulates: input 0 is a sawtooth of 1 V and 0.1 s, input 1
# a square wave. Read by instructions, an input gives what was written to the output of its number. WIRINGS is the folder
# of the wirings and the texture.
. "$GUEST/prelude.sh"
[ -c /dev/comedi0 ] || fail "comedi_test made no card"
cp "$WIRINGS"/* .
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
say "the drive moves the finger, because input 0 reads output 0"
code=0
timeout 200 "$TACTOGRAPH" play oak -d comedi:loop --rate 1kHz --at -1.1mm --gain 0.5mm/N --no-watchdog --time 500ms -o looped --json \
  >$results/looped.out 2>$results/looped.err || code=$?
echo $code >$results/looped.code
[ $code -eq 0 ] || cat $results/looped.err
"$TACTOGRAPH" doctor -d comedi:loop --json >$results/loop_doctor.json || true
say "a card that is not there"
take none none 100ms
cp saw.json saw.wav fast.json fast.wav stopped.json stopped.wav looped.session $results/
