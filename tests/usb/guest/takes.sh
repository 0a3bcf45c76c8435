# SPDX-License-Identifier: GPL-3.0-or-later
# What the scripts of faults share, after the prelude. Each take leaves NAME.code, NAME.out, NAME.err, NAME.valid, and its
# recording where there is one; NAME.late is how long it went on once the fault was there.
R=/guest/results
cp "$R"/source.* /guest/
SOURCE=replay:/guest/source,loop=1

now() { cut -d' ' -f1 /proc/uptime; }

# take NAME OPTION... : records, with whatever end.
take() {
  local name=$1 code=0; shift
  timeout 60 "$TACTOGRAPH" record -o "$name" --json "$@" >"$R/$name.out" 2>"$R/$name.err" || code=$?
  now >"$name.ended"
  echo "$code" >"$R/$name.code"
}

# keep NAME : what the recording is worth, and the recording itself.
keep() {
  local valid=0
  [ -e "$1.json" ] || "$TACTOGRAPH" recover "$1" >"$R/$1.recovered"
  "$TACTOGRAPH" validate "$1" >"$R/$1.valid" 2>&1 || valid=$?
  echo "exit $valid" >>"$R/$1.valid"
  cp "$1".* "$R/"
  rm -f "$1.wav"
}

# larger NAME BYTES : a quarter of a second is 40000.
larger() { [ "$(stat -c %s "$1.wav")" -gt "$2" ]; }
larger_or_over() { larger "$@" || [ -e "$1.ended" ]; }
# Its process is the child of timeout, which is the child of the take.
host() { cat /proc/[0-9]*/stat 2>/dev/null | awk '$2 == "(tactograph)" { print $1; exit }'; }

# during NAME COMMAND... : the command in the middle of a recording, which is what ends it.
during() {
  local name=$1 taking; shift
  take "$name" &
  taking=$!
  within 60 larger "$name" 40000
  now >"$name.begun"
  "$@"
  wait $taking
  echo "$(cat "$name.begun") $(cat "$name.ended")" | awk '{ print $2 - $1 }' >"$R/$name.late"
  keep "$name"
}

# amid NAME COMMAND... : the same where the recording goes on; it is stopped half a second of frames later.
amid() {
  local name=$1; shift
  during "$name" and_on "$name" "$@"
}
and_on() {
  local name=$1; shift
  "$@"
  within 60 larger_or_over "$name" $(($(stat -c %s "$name.wav") + 80000))
  kill -INT "$(host)" || true
}
