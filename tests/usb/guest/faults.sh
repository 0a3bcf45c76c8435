# SPDX-License-Identifier: GPL-3.0-or-later
# What goes wrong on a cable, one after the other. Each take leaves NAME.code, NAME.out, NAME.err, NAME.valid, and its
# recording where there is one; NAME.late is how long it went on once the fault was there.
. "$GUEST/prelude.sh"
R=/guest/results
cp "$R"/source.* /guest/
SOURCE=replay:/guest/source,loop=1

now() { cut -d' ' -f1 /proc/uptime; }

# take NAME OPTION... : records, with whatever end.
take() {
  local name=$1 code=0; shift
  timeout 60 "$TACTOGRAPH" record -o "$name" --json "$@" >"$R/$name.out" 2>"$R/$name.err" || code=$?
  now >"$name.ended"
  echo "$code" >"$R/$name.code"
}

# keep NAME : what the recording is worth, and the recording itself.
keep() {
  local valid=0
  [ -e "$1.json" ] || "$TACTOGRAPH" recover "$1" >"$R/$1.recovered"
  "$TACTOGRAPH" validate "$1" >"$R/$1.valid" 2>&1 || valid=$?
  echo "exit $valid" >>"$R/$1.valid"
  cp "$1".* "$R/"
  rm -f "$1.wav"
}

# larger NAME BYTES : a quarter of a second is 40000.
larger() { [ "$(stat -c %s "$1.wav")" -gt "$2" ]; }
larger_or_over() { larger "$@" || [ -e "$1.ended" ]; }
# Its process is the child of timeout, which is the child of the take.
host() { cat /proc/[0-9]*/stat 2>/dev/null | awk '$2 == "(tactograph)" { print $1; exit }'; }

# during NAME COMMAND... : the command in the middle of a recording, which is what ends it.
during() {
  local name=$1 taking; shift
  take "$name" &
  taking=$!
  within 60 larger "$name" 40000
  now >"$name.begun"
  "$@"
  wait $taking
  echo "$(cat "$name.begun") $(cat "$name.ended")" | awk '{ print $2 - $1 }' >"$R/$name.late"
  keep "$name"
}

# amid NAME COMMAND... : the same where the recording goes on; it is stopped half a second of frames later.
amid() {
  local name=$1; shift
  during "$name" and_on "$name" "$@"
}
and_on() {
  local name=$1; shift
  "$@"
  within 60 larger_or_over "$name" $(($(stat -c %s "$name.wav") + 80000))
  kill -INT "$(host)" || true
}

# faulty NAME FAULT OPTION... : a device that goes wrong by itself.
faulty() {
  local name=$1 fault=$2; shift 2
  start_gadget --board "$SOURCE" --serial F1 --fault "$fault"
  take "$name" "$@"
  [ ! -e "$name.json" ] || keep "$name"
  stop_gadget
}

unbind() { echo >"/sys/kernel/config/usb_gadget/tactograph-$UDC/UDC"; }
reset_bus() {
  for device in /sys/bus/usb/devices/*; do
    [ "$(cat "$device/serial" 2>/dev/null)" != F1 ] ||
      "$USB_RESET" "$(printf %03d "$(cat "$device/busnum")")" "$(printf %03d "$(cat "$device/devnum")")"
  done
}
held_up() {
  local held; held=$(host)
  kill -STOP "$held"; sleep 1; kill -CONT "$held"
}
killed() { kill -9 "$(host)"; }
as_nobody() { setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; }

say "a sound device, which needs no name"
start_gadget --board "$SOURCE" --serial F1
"$TACTOGRAPH" scan --json >"$R/scan.out"
take sound --time 2s
keep sound

say "a second program, and a user who may not"
amid first take second --time 1s
chmod o-rwx /dev/bus/usb/*/*
code=0
as_nobody "$TACTOGRAPH" record -o /guest/tmp/denied 2>"$R/denied.err" || code=$?
echo $code >"$R/denied.code"
as_nobody "$TACTOGRAPH" scan --json >"$R/denied.out"

say "resets, a host that is held up, a program that is killed"
amid reset reset_bus
amid held_up held_up
during killed killed
take after_killed --time 1s
keep after_killed

say "unplugging"
during unplugged unplug
replug
take replugged --time 1s
keep replugged
during unbound unbind
stop_gadget
start_gadget --board "$SOURCE" --serial F1
during powerless kill -9 $GADGET_PID
wait $GADGET_PID || true
gone

say "two devices"
start_gadget --board "$SOURCE" --serial F1
first=$GADGET_PID
"$GADGET" --udc dummy_udc.1 --board "$SOURCE" --serial F2 >>"$R/gadget.log" 2>&1 &
second=$!
both() { [ "$(cat /sys/class/udc/dummy_udc.1/state)" = configured ]; }
within 30 both
take unnamed --time 1s
take named -d usb:serial=F2 --time 1s
keep named
take missing -d usb:serial=F3 --time 1s
kill -TERM $first $second
wait $first $second || true

say "devices that go wrong"
faulty corrupt corrupt-every=40 --time 2s
faulty allowed corrupt-every=40 --time 1s --allow-gaps
faulty dropped drop-every=40 --time 2s
faulty truncated truncate-every=40 --time 2s
faulty repeated repeat-every=40 --time 1s
faulty packets packet=100 --time 2s
faulty stalled stall-after=100 --time 2s
faulty let_go unplug-after=150
faulty silent silent-after=150
faulty deaf deaf-after=1 --time 1s
faulty newer version=2.0 --time 1s
