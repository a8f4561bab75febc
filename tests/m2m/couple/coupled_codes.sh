#!/usr/bin/env bash
# Coupled codes hold on every machine.
#
#     coupled_codes.sh PROGRAM [SANITIZER]   with a sanitizer, which keeps memory, without `repeats`; with the thread sanitizer,
#                                            which knows nothing of MPI, without ranks
source "$(dirname "$0")/../../support/checks.sh"
program=$1
limit=120
codes=(components migration balancing three_at_once many_fields motion empty_pieces births two_kinds weights_by_hand destroyed retired rounds)
# all_hold COMMAND…: every code reports that it holds.
all_hold() {
  exits 0 "rounds: holds" "$@" "${codes[@]}"
  [[ $(grep -c ': holds$' "$scratch/out") -eq ${#codes[@]} ]] && pass || fail "not all hold: $*"
}

all_hold "$program" --pes 1
all_hold "$program" --pes 2
all_hold "$program" --sim pes=4,per-process=2,cost=100ns,seed=3
all_hold "$program" --sim pes=6,per-process=1,cost=100ns,migrate=0.2,seed=5
if [[ ${2:-} != *thread* ]]; then
  all_hold "${mpirun[@]}" -n 2 "$program" --pes 1
  all_hold "${mpirun[@]}" -n 3 "$program" --pes 1
fi
[[ -n ${2:-} ]] || exits 0 "repeats: holds" "$program" repeats --pes 2

finish
