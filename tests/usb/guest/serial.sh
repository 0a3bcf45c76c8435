# SPDX-License-Identifier: GPL-3.0-or-later
# Two serial ports on USB: an FTDI adapter with the firmware of a board behind it, which QEMU emulates outside of this machine,
# and a port of the class ACM whose device side is this kernel's, with the gadget's board behind it. SOURCE is what that board
# plays out; TEXTURES has a texture.
. "$GUEST/prelude.sh"
R=/guest/results
cp "$TEXTURES"/oak.* .
driver_of() { basename "$(readlink -f "/sys/class/tty/$1/device/driver")"; }

# on_port NAME ARGUMENTS... : the command; what it prints is in NAME.out and NAME.err, its exit code in NAME.code.
on_port() {
  name=$1; shift
  code=0
  timeout 300 "$TACTOGRAPH" "$@" --json >$R/"$name".out 2>$R/"$name".err || code=$?
  echo $code >$R/"$name".code
}

within 60 test -c /dev/ttyUSB0
driver_of ttyUSB0 >$R/drivers
say "the board behind the adapter is the only one that is found"
on_port ftdi_scan scan
on_port ftdi_doctor doctor -d tty:
for attempt in 1 2 3; do  # a computer that is too slow loses frames, or ends a playback by the board's watchdog
  rm -f ftdi.*
  on_port ftdi_record record -d tty: --time "${SECONDS_WANTED}s" -o ftdi
  [ "$(cat $R/ftdi_record.code)" -ne 0 ] || break
done
say "it plays"
for attempt in 1 2 3; do
  rm -f played.session
  on_port ftdi_play play oak -d tty:/dev/ttyUSB0 --transducer wiertlewski2011 --rate 1kHz --gain 0.1mm/N --interpolation sinc --time 2s -o played
  [ "$(cat $R/ftdi_play.code)" -ne 0 ] || break
done

say "a port of the class ACM"
acm=/sys/kernel/config/usb_gadget/acm
mkdir $acm $acm/functions/acm.0 $acm/configs/c.1 $acm/strings/0x409
echo 0x1209 >$acm/idVendor
echo 0x0001 >$acm/idProduct
echo "tactograph serial" >$acm/strings/0x409/product
ln -s $acm/functions/acm.0 $acm/configs/c.1
echo $UDC >$acm/UDC
within 60 test -c /dev/ttyACM0
within 60 test -c /dev/ttyGS0
driver_of ttyACM0 >>$R/drivers
stty -F /dev/ttyGS0 raw -echo
mkdir -p /dev/pts
mount -t devpts devpts /dev/pts
# serve OPTION... : the gadget's board behind the port.
serve() {
  "$GADGET" --pty board "$@" >>$R/gadget.log 2>&1 &
  GADGET_PID=$!
  within 60 test -e board
  cat board >/dev/ttyGS0 2>/dev/null &
  cat /dev/ttyGS0 >board 2>/dev/null &
  TO_BOARD=$!
}
serve --board "replay:$SOURCE" --serial A1
on_port both_scan scan
on_port acm_record record -d tty:/dev/ttyACM0 --time 1s -o acm
on_port acm_doctor doctor -d tty:/dev/ttyACM0
stop_gadget
kill $TO_BOARD
say "a transducer is identified"
serve --board sim:tray_sensor=on,rate=4kHz,seed=3 --serial A2
for attempt in 1 2 3 4 5 6; do  # on a processor that QEMU translates, the drive may come too late
  on_port acm_identify identify -d tty:/dev/ttyACM0 --method multisine --high 900Hz -o found --force
  [ "$(cat $R/acm_identify.code)" -ne 0 ] || break
done
stop_gadget
cp ftdi.* acm.* played.session $R/
