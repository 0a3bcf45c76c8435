# SPDX-License-Identifier: GPL-3.0-or-later
# What guest scripts share: `. "$GUEST/prelude.sh"` first. Ends the script at the first command that fails.
set -eu
UDC=dummy_udc.0

say() { echo "== $*"; }
fail() { echo "FAILED: $*" >&2; exit 1; }

# within SECONDS CONDITION... : waits until the condition's command succeeds.
within() {
  tries=$(($1 * 20)); shift
  while ! "$@" 2>/dev/null; do
    tries=$((tries - 1))
    [ "$tries" -gt 0 ] || fail "did not come to pass: $*"
    sleep 0.05
  done
}

udc_is() { [ "$(cat /sys/class/udc/$UDC/state)" = "$1" ]; }

# start_gadget OPTION... : the device, plugged in and configured by the host side. Its words go to gadget.log.
start_gadget() {
  "$GADGET" --udc $UDC "$@" >>/guest/results/gadget.log 2>&1 &
  GADGET_PID=$!
  within 30 gadget_ready
}
gadget_ready() { kill -0 $GADGET_PID || { cat /guest/results/gadget.log; fail "the gadget ended"; }; udc_is configured; }

stop_gadget() {
  kill -TERM $GADGET_PID
  wait $GADGET_PID || fail "the gadget ended with $?"
}

# What pulling the cable and putting it back does, seen from both sides.
unplug() { echo disconnect >/sys/class/udc/$UDC/soft_connect; }
replug() { echo connect >/sys/class/udc/$UDC/soft_connect; within 30 udc_is configured; }
