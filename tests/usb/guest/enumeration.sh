# SPDX-License-Identifier: GPL-3.0-or-later
# What the kernel sees of the device at each speed, and a second of recording at it. SOURCE is what it plays out.
. "$GUEST/prelude.sh"

# at_speed NAME PARAMETERS... : the same cable at another speed.
at_speed() {
  name=$1; shift
  /bin/busybox rmmod dummy_hcd
  /bin/busybox insmod "$KERNEL/dummy_hcd.ko" num=2 "$@"
  start_gadget --board "replay:$SOURCE" --serial "at-$name"
  device=/sys/bus/usb/devices/$(cd /sys/bus/usb/devices && grep -l "at-$name" */serial | cut -d/ -f1)
  interface=$(echo "$device":1.0)
  {
    for file in idVendor idProduct serial speed bNumConfigurations; do echo "$file $(cat "$device/$file")"; done
    for file in bInterfaceClass bInterfaceSubClass bInterfaceProtocol bNumEndpoints interface; do
      echo "$file $(cat "$interface/$file")"
    done
    for endpoint in "$interface"/ep_*; do
      echo "endpoint $(cat "$endpoint/direction") $(cat "$endpoint/type") $((0x$(cat "$endpoint/wMaxPacketSize")))"
    done
  } >"/guest/results/$name.txt"
  [ -e /guest/results/scan.json ] || timeout 60 "$TACTOGRAPH" scan --json >/guest/results/scan.json
  timeout 60 "$TACTOGRAPH" record -d "usb:serial=at-$name" -o "$name" --time 1s >record.txt 2>&1 || { cat record.txt; fail "no recording at $name speed"; }
  cp "$name.wav" /guest/results/
  stop_gadget
  rm "$name".*
}

at_speed high
at_speed full is_high_speed=0
at_speed super is_super_speed=1
