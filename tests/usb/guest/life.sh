# SPDX-License-Identifier: GPL-3.0-or-later
# The gadget's life: pulled out and plugged in again, its port closed and opened, ended, killed, started again; and how
# it refuses. SOURCE is what it plays out.
. "$GUEST/prelude.sh"
CONFIG=/sys/kernel/config/usb_gadget

records() {
  timeout 60 "$TACTOGRAPH" record -d usb: -o "$1" --time 300ms >"$1.txt" 2>&1 || { cat "$1.txt"; fail "no recording $1"; }
  cmp -n 20000 "$1.wav" first.wav
}

# refused WORDS COMMAND... : it fails, in one line that has the words.
refused() {
  words=$1; shift
  if "$@" 2>refusal; then fail "not refused: $*"; fi
  cat refusal
  [ "$(wc -l <refusal)" = 1 ] || fail "more than one line"
  grep -q "$words" refusal || fail "does not say: $words"
}

say "started"
start_gadget --board "replay:$SOURCE"
timeout 60 "$TACTOGRAPH" record -d usb: -o first --time 300ms >/dev/null 2>&1
say "pulled out and plugged in"
unplug
replug
records replugged
say "its port closed and opened from outside"
echo >"$CONFIG/tactograph-$UDC/UDC"
gone
echo $UDC >"$CONFIG/tactograph-$UDC/UDC"
within 30 host_sees
records reopened
say "a second one on the same port"
refused "already uses $UDC" "$GADGET" --board sim: --udc $UDC
say "ended"
stop_gadget
[ -z "$(ls $CONFIG)" ] || fail "something is left in configfs: $(ls $CONFIG)"
[ -z "$(ls /guest/tmp)" ] || fail "something is left in /guest/tmp: $(ls /guest/tmp)"
say "killed while it streams, and started again"
start_gadget --board "replay:$SOURCE,loop=1"
timeout 60 "$TACTOGRAPH" record -d usb: -o killed --time 30s >/dev/null 2>killed.txt & RECORD_PID=$!
within 30 test -s killed.wav
sleep 1
kill -9 $GADGET_PID
if wait $RECORD_PID; then fail "the recording did not notice"; fi
tail -1 killed.txt
grep -q 'ended early' killed.txt && ! grep -q converter killed.txt || fail "it ended for another reason"
timeout 60 "$TACTOGRAPH" validate killed
gone
start_gadget --board "replay:$SOURCE"
records restarted
stop_gadget
say "refusals"
refused "is not a known board" "$GADGET" --board piezo:
refused "there is no option" "$GADGET" --bord sim:
refused "needs a value" "$GADGET" --board
refused "there is no device port" "$GADGET" --udc nowhere
refused "nothing" "$GADGET" --board replay:nothing
refused "run as root" setpriv --reuid 65534 --clear-groups "$GADGET" --board sim:
/bin/busybox rmmod dummy_hcd
refused "no USB device port" "$GADGET"
/bin/busybox insmod "$KERNEL/dummy_hcd.ko"
umount /sys/kernel/config
refused "no USB gadget support" "$GADGET"
