#!/usr/bin/env bash
# The live view in a terminal: terminal.sh STENCIL TESS_MONITOR [MPIEXEC]. It sums up the heat maps of a run on one process
# and of 2 048 simulated PEs, or with MPIEXEC of two processes.
source "$(dirname "$0")/../../../support/checks.sh"
stencil=$1 monitor=$2
run=

# begin COMMAND…: starts a run in the background; `at` is where it serves.
begin() {
  : >"$scratch/lines"
  "$@" >"$scratch/run" 2>"$scratch/lines" &
  run=$!
  for _ in $(seq 200); do
    at=$(grep -oE '(127\.0\.0\.1|\[::1\]):[0-9]+' "$scratch/lines")
    if [[ -n $at ]]; then return; fi
    sleep 0.1
  done
  fail "no monitor: $*"
}
end() {
  kill -TERM "$run" 2>/dev/null
  wait "$run" 2>/dev/null
}
# sees TEXT OPTION…: within some frames the table has this text.
sees() {
  local want=$1
  shift
  timeout 60 "$monitor" --connect "$at" "$@" >"$scratch/out" 2>"$scratch/err" &
  local watcher=$!
  while kill -0 "$watcher" 2>/dev/null && ! grep -q -- "$want" "$scratch/out"; do sleep 0.1; done
  if grep -q -- "$want" "$scratch/out"; then pass; else fail "not seen: $want"; tail -5 "$scratch/out" "$scratch/err"; fi
  kill "$watcher" 2>/dev/null
  wait "$watcher" 2>/dev/null
}
problem=(--size 256 --blocks 8 --steps 1000000000)

if [[ -n ${3:-} ]]; then
  begin "$3" "${mpirun_options[@]}" -n 2 "$stencil" --pes 2 --monitor 0 "${problem[@]}"
  sees 'Block by load: hottest \[' --heat Block
  sees 'Block by pe: 64 elements on 4 of 4 PEs, at most 16' --heat Block --by pe
  end
  finish
  exit
fi

begin "$stencil" --pes 2 --monitor 0 "${problem[@]}"
sees 'stencil::Block *64 *32 *32' --frames 40
sees ' s, 2 PEs in 1 process, [0-9]* epochs* open, 0 migrations' --frames 4
sees 'PEs wait [0-9.]* % of the time' --frames 4
sleep 3
second=$(timeout 20 "$monitor" --connect "$at" --frames 1 | sed -n '1s/^\([0-9]*\)[.].*/\1/p')
if ((${second:-0} >= 2)); then pass; else fail "a frame of the past: second ${second:-none}"; fi
sees 'Block by load: hottest \[[0-7],[0-7]\]: ' --heat Block
sees 'Block by pe: 64 elements on 2 of 2 PEs, at most 32' --heat Block --by pe
sees 'no array is named Blok yet' --heat Blok
exits 2 'localhost:83616: 83616 is no port; give HOST:PORT' "$monitor" --connect localhost:83616
exits 2 '\-\-by' "$monitor" --connect "$at" --heat Block --by size
end
exits 2 'is the run started with --monitor' "$monitor" --connect "$at"

if grep -q '^0\{31\}1 ' /proc/net/if_inet6 2>/dev/null; then  # this machine has ::1
  begin "$stencil" --pes 2 --monitor '[::1]:0' "${problem[@]}"
  sees 'stencil::Block *64 *32 *32' --frames 40
  end
fi

begin "$stencil" --sim pes=2048,cost=1us --monitor 0 --size 2048 --blocks 64 --steps 1000000000
sees 'Block by pe: 4096 elements on 2048 of 2048 PEs, at most 2' --heat Block --by pe
sees 'Block by load: hottest \[' --heat Block
end

finish
