# SPDX-License-Identifier: GPL-3.0-or-later
# SECONDS of recording, and drive the other way at the same time. SOURCE is what the device plays out.
. "$GUEST/prelude.sh"
start_gadget --board "replay:$SOURCE" --serial U1
say "$SECONDS_WANTED s, both ways"
timeout $((SECONDS_WANTED + 60)) "$USB_LINK" usb:serial=U1 oak "$SECONDS_WANTED"
cut -d' ' -f14,15 /proc/$GADGET_PID/stat; cat /proc/uptime
cp oak.wav oak.json /guest/results/
stop_gadget
