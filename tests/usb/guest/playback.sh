# SPDX-License-Identifier: GPL-3.0-or-later
# The daemon plays oak on a device behind the cable, whose emulated finger goes there, back and rests: SECONDS_WANTED in
# device loop, then stopped (SIGSTOP) in mid-play, then in host loop, then killed in mid-play, then unplugged. Config
# NAME.json and texture come by results.
. "$GUEST/prelude.sh"
R=/guest/results
mkdir -p /run/lock
cp "$R"/oak.texture.* /guest/
ctl() { timeout 60 "$TACTOGRAPH" ctl "$@" --socket /guest/control; }
status() { ctl status --json >"$R/$1.json"; }

# daemon NAME : one that is ready.
daemon() {
  "$TACTOGRAPHD" --config "$R/$1.config.json" 2>"$R/$1.log" &
  DAEMON_PID=$!
  within 60 daemon_ready "$1"
}
falls() { grep -c "the drive went from" "$R/gadget.log" || true; }
fell() { [ "$(falls)" -gt "$FALLS" ]; }
rises() { grep -c "the drive increases" "$R/gadget.log" || true; }
rose() { [ "$(rises)" -gt "$RISES" ]; }
daemon_ready() { kill -0 $DAEMON_PID || { cat "$R/$1.log"; fail "tactographd ended"; }; grep -q ready "$R/$1.log"; }
begin() {
  ctl load oak --gain 0.5mm/N
  ctl arm
  ctl play
  within 20 plays
}
plays() { ctl status | grep -q playing; }
end_daemon() {
  kill -TERM $DAEMON_PID
  wait $DAEMON_PID || fail "tactographd ended with $?"
}
keep() { cp "$(sed -n 's/^ *"session": "\(.*\)".*/\1/p' "$R/$1.json")" "$R/$1.session"; }

# stopped NAME : the daemon that plays stands still (SIGSTOP) until the drive has fallen, and goes on (SIGCONT). How often the
# drive rises within 3 s is in NAME.woken; then it is asked to play again, so that a rise is known to be seen.
stopped() {
  FALLS=$(falls)
  kill -STOP $DAEMON_PID
  within 20 fell
  grep "the drive went from" "$R/gadget.log" | tail -1 >"$R/$1.fall"
  RISES=$(rises)
  kill -CONT $DAEMON_PID
  sleep 3
  echo $(($(rises) - RISES)) >"$R/$1.woken"
  status "$1"
  ctl disarm
  begin
  within 20 rose
}

# played NAME SECONDS : from ready to a session that is kept; then, in device loop, stopped in mid-play.
played() {
  daemon "$1"
  begin
  sleep "$2"
  status "$1"
  ctl stop
  sleep 0.3
  ctl disarm
  keep "$1"
  if [ "$1" = device ]; then
    begin
    stopped stopped
  fi
  end_daemon
}

start_gadget --board sim:rate=2kHz,strokes=1000,surface=C --serial P1
"$TACTOGRAPH" scan --json >"$R/scan.out"
say "device loop, $SECONDS_WANTED s"
played device "$SECONDS_WANTED"
say "host loop, $HOST_SECONDS s"
played host "$HOST_SECONDS"

# The finger may be at rest when the device misses its host: another daemon is killed then, after another time, because
# the guest's clock counts instructions, so that equal waits would meet equal places of the finger.
say "killed in mid-play; the next one takes over"
for attempt in 1 2 3 4 5 6 7 8 9 10 11 12; do
  daemon killed
  begin
  sleep "1.$((7 * attempt % 10))"
  status killed
  FALLS=$(falls)
  kill -9 $DAEMON_PID
  wait $DAEMON_PID || true
  within 20 fell
  grep "the drive went from" "$R/gadget.log" | tail -1 >"$R/killed.fall"
  grep -q "from 0.0" "$R/killed.fall" || break
done
keep killed
daemon after
status after
begin
sleep 1
status after

say "a second daemon with a socket of its own, and play, on the device that plays"
refused() {
  name=$1; shift
  if timeout 60 "$@" >"$R/$name.said" 2>&1; then fail "a second one took the device: $*"; fi
}
refused second "$TACTOGRAPHD" --config "$R/second.config.json"
refused beside "$TACTOGRAPH" play oak -d usb: --gain 0.5mm/N --time 1s -o beside
[ ! -e beside.session ] || fail "play wrote a session of nothing"
status undisturbed

say "unplugged in mid-play"
FALLS=$(falls)
unplug
within 20 fell
grep "the drive went from" "$R/gadget.log" | tail -1 >"$R/unplugged.fall"
lost() { ctl status | grep -q lost; }
within 20 lost
status unplugged
keep after
replug
begin
sleep 1
status replugged
end_daemon
stop_gadget
