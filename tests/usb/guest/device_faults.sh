# SPDX-License-Identifier: GPL-3.0-or-later
# Devices that go wrong by themselves.
. "$GUEST/prelude.sh"
. "$GUEST/takes.sh"
faulty_gadget() { exec "$FAULTY_GADGET" "$fault" "$@"; }
GADGET=faulty_gadget

# faulty NAME FAULT OPTION... : a device that goes wrong by itself.
faulty() {
  local name=$1 fault=$2; shift 2
  start_gadget --board "$SOURCE" --serial F1
  take "$name" "$@"
  [ ! -e "$name.json" ] || keep "$name"
  stop_gadget
}

faulty corrupt corrupt-every=40 --time 2s
faulty allowed corrupt-every=40 --time 1s --allow-gaps
faulty dropped drop-every=40 --time 2s
faulty truncated truncate-every=40 --time 2s
faulty repeated repeat-every=40 --time 1s
faulty packets packet=300 --time 1s
faulty exact packet=512 --time 1s
faulty stalled stall-after=100 --time 2s
faulty let_go unplug-after=150
faulty silent silent-after=150
faulty deaf deaf-after=1 --time 1s
faulty newer version=2.0 --time 1s
