# SPDX-License-Identifier: GPL-3.0-or-later
# What people and programs do to a sound device and its cable in the middle of a recording.
. "$GUEST/prelude.sh"
. "$GUEST/takes.sh"

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
