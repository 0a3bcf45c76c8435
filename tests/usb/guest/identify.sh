# SPDX-License-Identifier: GPL-3.0-or-later
# A transducer behind the cable is identified: the drive goes out, and what the tray's sensor saw comes back.
. "$GUEST/prelude.sh"
R=/guest/results
mkdir -p /run/lock
start_gadget --board sim:tray_sensor=on,rate=4kHz,seed=3 --serial I1

identify() {
  timeout 200 "$TACTOGRAPH" identify -d usb: --method multisine --high 900Hz -o found --force --json >"$R/identify.out" 2>"$R/identify.err"
}

# A processor that QEMU translates stalls: the drive comes too late then, and the command says so and writes nothing.
for attempt in 1 2 3 4 5 6; do
  if identify; then
    cp found.transducer.json "$R/"
    break
  fi
  cat "$R/identify.err"
  grep -q "it arrived too late" "$R/identify.err" || fail "identify failed for another reason"
  [ ! -e found.transducer.json ] || fail "a transducer was written all the same"
done
[ -e "$R/found.transducer.json" ] || fail "it arrived too late each time"
stop_gadget
