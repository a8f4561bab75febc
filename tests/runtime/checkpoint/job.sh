#!/usr/bin/env bash
# job.sh JOB: arrays of all kinds, a group and a section go from machine to machine, with the log of a run that never stopped.
source "$(dirname "$0")/../../support/checks.sh"
job=$1

# logs FIRST COMMAND…: exit code 0, begun at that step; prints the log.
logs() {
  local first=$1
  shift
  timeout 100 "$@" >"$scratch/out" 2>&1 && grep -q "^from $first log " "$scratch/out" && pass && return
  fail "$* did not begin at step $first"
  tail -5 "$scratch/out"
}
log_of() { sed -n 's/^from [0-9]* log //p' "$scratch/out"; }

logs 0 "$job" "$scratch/whole" 16 --pes 3
want=$(log_of)
logs 0 "$job" "$scratch/saved" 4 --pes 4
logs 4 "${mpirun[@]}" -n 2 "$job" "$scratch/saved" 6 --pes 1
logs 6 "${mpirun[@]}" -n 3 "$job" "$scratch/saved" 8 --pes 2
logs 8 "$job" "$scratch/saved" 10 --sim pes=8,per-process=2,cost=100ns,seed=4
logs 10 "$job" "$scratch/saved" 12 --pes 1
logs 12 "${mpirun[@]}" -n 2 "$job" "$scratch/saved" 14 --pes 2
logs 14 "$job" "$scratch/saved" 16 --pes 3
[[ -n $want && $(log_of) == "$want" ]] && pass || fail "the log is $(log_of), not $want"
exits 1 "checkpoint() to a path without a name: give a folder" "$job" "" 4 --pes 2
finish
