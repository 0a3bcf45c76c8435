# SPDX-License-Identifier: GPL-3.0-or-later
# What guest scripts share: `. "$GUEST/prelude.sh"` first. Ends the script at the first command that fails.
set -eu
UDC=dummy_udc.0

say() { echo "== $*"; }
fail() { echo "FAILED: $*" >&2; exit 1; }

# within SECONDS CONDITION... : waits until the condition's command succeeds.
within() {
  deadline=$(($(date +%s) + $1)); shift
  while ! "$@" 2>/dev/null; do
    [ "$(date +%s)" -lt "$deadline" ] || fail "did not come to pass: $*"
    sleep 0.05
  done
}

# start_gadget OPTION... : the device, plugged in and configured by the host side. Its words go to gadget.log.
start_gadget() {
  "$GADGET" --udc $UDC "$@" >>/guest/results/gadget.log 2>&1 &
  GADGET_PID=$!
  within 30 gadget_ready
}
gadget_ready() { kill -0 $GADGET_PID || { cat /guest/results/gadget.log; fail "the gadget ended"; }; host_sees; }

stop_gadget() {
  kill -TERM $GADGET_PID
  wait $GADGET_PID || fail "the gadget ended with $?"
}

# The kernel's host side has the device, or has not.
host_sees() { ls -d /sys/devices/platform/dummy_hcd.0/usb*/*-1/*-1:1.0 >/dev/null 2>&1; }
host_misses() { ! host_sees; }

# What pulling the cable and putting it back does, seen from both sides. This kernel's soft_connect lets go but does not
# take the line again (dummy_hcd stays without its callbacks): binding anew does.
unplug() { echo disconnect >/sys/class/udc/$UDC/soft_connect; gone; }
gone() { within 30 host_misses; }
replug() {
  port=/sys/kernel/config/usb_gadget/tactograph-$UDC/UDC
  echo >$port
  echo $UDC >$port
  within 30 host_sees
}
