#!/usr/bin/env bash
# Couplings that restart on another machine, without a search, give the bits of a run that does not stop.
#
#     restarts.sh PROGRAM [SANITIZER]   with the thread sanitizer, which knows nothing of MPI, without ranks
source "$(dirname "$0")/../../support/checks.sh"
program=$1
limit=120

exits 0 "^hash" "$program" "$scratch/none" whole --pes 1
hash=$(cat "$scratch/out")
# restarts BEFORE AFTER AGAIN: machines, as words before and after the program; each run begins with the checkpoint of the last.
restarts() {
  local folder=$scratch/saved$((passed + failed)) how=save want="^saved$" machine
  for machine in "$@"; do
    exits 0 "$want" ${machine%@*} "$program" "$folder" $how ${machine#*@}
    how=resume want="^$hash$"
  done
}
restarts "@--pes 1" "@--pes 2" "@--pes 1"
restarts "@--pes 2" "@--pes 1" "@--pes 3"
for seed in 1 2 3; do
  restarts "@--sim pes=4,per-process=2,cost=100ns,migrate=0.2,seed=$seed" \
    "@--sim pes=$((2 + seed)),cost=100ns,migrate=0.2,seed=$seed" "@--sim pes=1,cost=100ns,seed=$seed"
done
if [[ ${2:-} != *thread* ]]; then
  restarts "${mpirun[*]} -n 2@--pes 1" "@--pes 1" "${mpirun[*]} -n 2@--pes 2"
fi

exits 0 "^hash" "$program" "$scratch/early" early --pes 2
exits 0 "^$(cat "$scratch/out")$" "$program" "$scratch/early" resume --pes 1
exits 0 "^saved$" "$program" "$scratch/lost" lose --pes 2
exits 1 "Zone\[2\], a source piece of coupling .*, was destroyed after the last search" "$program" "$scratch/lost" lost --pes 1

finish
