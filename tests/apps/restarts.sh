#!/usr/bin/env bash
# restarts.sh BIN: leanmd, amr and nqueens stop on 4 threads and restart on 2 ranks, on 7 simulated PEs and on one PE, with
# and without balancing, with the result_hash of a run that never stopped; stencil restarts; and what is refused.
source "$(dirname "$0")/../support/checks.sh"
bin=$1
folder=$scratch/saved

hash_of() { grep -o '"result_hash": "[0-9a-f]*"' "$1"; }
# runs COMMAND…: exit code 0; its result is in run.json.
runs() {
  rm -f "$scratch/run.json"
  timeout 100 "$@" --json "$scratch/run.json" >"$scratch/out" 2>&1 && pass && return
  fail "$*"
  tail -5 "$scratch/out"
}
same() {
  [[ -n $want && $(hash_of "$scratch/run.json") == "$want" ]] && pass && return
  fail "another result: $*"
}
# from_machine_to_machine PROGRAM EVERY FIRST SECOND THIRD LAST OPTIONS…: the runs end after these steps, with checkpoints
# after each EVERY; the result of the last one is compared. $balance holds options of the second run and of later ones.
from_machine_to_machine() {
  local program=$bin/$1 every=$2 first=$3 second=$4 third=$5 last=$6
  shift 6
  rm -rf "$folder"
  runs "$program" "$@" --steps "$last" --pes 2
  want=$(hash_of "$scratch/run.json")
  local often=(--checkpoint "$folder" --checkpoint-every "$every")
  runs "$program" "$@" --steps "$first" --pes 4 "${often[@]}"
  runs "${mpirun[@]}" -n 2 "$program" --steps "$second" --pes 1 "${often[@]}" --restart "$folder" $balance
  says '^continues after step'
  runs "$program" --steps "$third" --sim "pes=7,cost=100ns,seed=$first,migrate=0.05" "${often[@]}" --restart "$folder" $balance
  says '^continues after step'
  runs "$program" --steps "$last" --pes 1 --restart "$folder" $balance
  same "$program $* $balance"
}

problem=(--atoms 600 --density 0.6 --cells 3,2,3 --exchange 4 --every 5 --gradient 1)
balance= from_machine_to_machine leanmd 7 17 25 33 40 "${problem[@]}"
balance="--balance greedy" from_machine_to_machine leanmd 4 17 25 33 40 "${problem[@]}" --check
balance="--balance rotate" from_machine_to_machine leanmd 6 17 25 33 40 "${problem[@]}" --balance greedy_refine --check
# With the options given again; the way back after a restart. Without --steps a run ends where the one before was to end.
runs "$bin/leanmd" "${problem[@]}" --steps 40 --pes 2 --restart "$folder" --reverse --check
same "leanmd --reverse after a restart"
says "forces as of all pairs"
runs "$bin/leanmd" --pes 2 --restart "$folder"
says " 33 steps: "
exits 2 "--atoms: 700, but the checkpoint has 600: leave the option out" "$bin/leanmd" --atoms 700 --pes 2 --restart "$folder"
exits 2 "--cells: 3,3,3, but the checkpoint has 3,2,3" "$bin/leanmd" --cells 3,3,3 --pes 2 --restart "$folder"
exits 2 "--steps: 5, but the checkpoint has done" "$bin/leanmd" --steps 5 --pes 2 --restart "$folder"
exits 2 "does not work with --st" "$bin/leanmd" --study --checkpoint "$scratch/none"
exits 2 "was written by a program\|of the class" "$bin/amr" --pes 2 --restart "$folder"
# The rounds before the restart are in the result, too.
grep -q '"max_over_average"' "$scratch/run.json" && pass || fail "no rounds of before the restart"
# Options that are given again need not work with the defaults of the others.
rm -rf "$folder"
small=(--atoms 20 --steps 10 --pes 2)
runs "$bin/leanmd" "${small[@]}" --density 0.02 --cells 1,1,1 --cutoff 4 --checkpoint "$folder" --checkpoint-every 5
runs "$bin/leanmd" "${small[@]}" --restart "$folder"

problem=(--cells 4 --max-level 4 --change-every 3)
balance= from_machine_to_machine amr 5 14 20 26 32 "${problem[@]}"
balance="--balance greedy_refine" from_machine_to_machine amr 2 14 20 26 32 "${problem[@]}"
balance="--balance rotate" from_machine_to_machine amr 1 14 20 26 32 "${problem[@]}" --balance hilbert
runs "$bin/amr" --steps 32 --pes 1 --restart "$folder"
grep -q '"moved": [1-9]' "$scratch/run.json" && pass || fail "no moves of before the restart"
exits 2 "--order: 3, but the checkpoint has 2" "$bin/amr" --order 3 --pes 2 --restart "$folder"
exits 2 "--uncorrected: yes, but the checkpoint has no" "$bin/amr" --uncorrected --pes 2 --restart "$folder"
exits 2 "does not work with --st" "$bin/amr" --stability --checkpoint "$scratch/none"
rm -rf "$folder"
runs "$bin/amr" --least-level 1 --max-level 1 --width 0.06 --steps 9 --pes 2 --checkpoint "$folder" --checkpoint-every 4
runs "$bin/amr" --max-level 1 --width 0.06 --pes 2 --restart "$folder"
exits 2 "--width: 0.06000003, but the checkpoint has 0.06:" "$bin/amr" --width 0.06000003 --pes 2 --restart "$folder"

rm -rf "$folder"
runs "$bin/stencil" --size 200 --blocks 100 --steps 10 --pes 2 --checkpoint "$folder" --checkpoint-every 5
want=$(hash_of "$scratch/run.json")
runs "$bin/stencil" --blocks 100 --pes 2 --restart "$folder"
same "stencil --blocks 100 after a restart"

# The parts of nqueens are its steps. The first two runs are killed once they have written a checkpoint.
latest() { ls -d "$folder"/*/manifest.json 2>/dev/null | tail -1; }
# until_checkpoint COMMAND…
until_checkpoint() {
  local before child
  before=$(latest)
  "$@" >"$scratch/out" 2>&1 &
  child=$!
  while kill -0 $child 2>/dev/null && [[ $(latest) == "$before" ]]; do sleep 0.002; done
  [[ $(latest) != "$before" ]] && pass || fail "no new checkpoint: $*"
  kill -9 $child 2>/dev/null
  wait $child 2>/dev/null
}
often=(--checkpoint "$folder" --checkpoint-every 40)
for form in group chares; do
  rm -rf "$folder"
  runs "$bin/nqueens" 14 --form $form --pes 2
  want=$(hash_of "$scratch/run.json")
  until_checkpoint "$bin/nqueens" 14 --form $form --pes 4 "${often[@]}"
  until_checkpoint "$bin/nqueens" 14 --sim pes=7,cost=100ns,seed=5 "${often[@]}" --restart "$folder"
  runs "${mpirun[@]}" -n 2 "$bin/nqueens" --pes 1 --form $form --restart "$folder" --checkpoint "$folder"
  says '^continues after step'
  same "nqueens 14 --form $form"
  runs "$bin/nqueens" --pes 1 --restart "$folder"
  same "nqueens 14 --form $form once more"
done
rm -rf "$folder"
runs "$bin/nqueens" 8 --first --pes 3
want=$(hash_of "$scratch/run.json")
runs "$bin/nqueens" 8 --first --pes 2 --checkpoint "$folder" --checkpoint-every 1
same "nqueens 8 --first in parts"
runs "$bin/nqueens" --restart "$folder" --pes 1
same "nqueens --first after a restart"
exits 2 "--expect 5: --first does not count" "$bin/nqueens" --expect 5 --restart "$folder" --pes 1
exits 2 "N: 9, but the checkpoint has 8" "$bin/nqueens" 9 --pes 2 --restart "$folder"
exits 2 "does not work with --st" "$bin/nqueens" 9 --study --checkpoint "$scratch/none"

# run_forever.sh starts a program that dies again, with all its options.
cat >"$scratch/dies" <<END2
#!/usr/bin/env bash
# amr; the first run dies once it has written a checkpoint.
[[ -e "$scratch/died" ]] && exec "$bin/amr" "\$@"
touch "$scratch/died"
"$bin/amr" "\$@" &
while kill -0 \$! 2>/dev/null && ! ls "$scratch/forever"/*/manifest.json >/dev/null 2>&1; do sleep 0.002; done
kill -9 \$!
wait \$!
exit 137
END2
problem=(--cells 4 --max-level 4 --steps 40 --pes 2)
runs "$bin/amr" "${problem[@]}"
want=$(hash_of "$scratch/run.json")
runs bash "$(dirname "$0")/../../apps/run_forever.sh" "$scratch/forever" bash "$scratch/dies" "${problem[@]}" --checkpoint-every 4
says 'started again from checkpoint-'
same "run_forever.sh"

# Ctrl-C sends SIGINT to the script and to mpirun, which ends with 1: the program is not started again.
printf '#!/bin/sh\necho >>"%s/starts"\nexec sleep 60\n' "$scratch" >"$scratch/sleeps"
setsid env --default-signal=INT bash "$(dirname "$0")/../../apps/run_forever.sh" "$scratch/none" \
  "${mpirun[@]}" -n 1 sh "$scratch/sleeps" >"$scratch/out" 2>&1 </dev/null &
job=$!
for ((i = 0; i < 200; ++i)); do
  [[ -s $scratch/starts ]] && break
  sleep 0.1
done
kill -INT -- -$job
for ((i = 0; i < 200; ++i)); do
  kill -0 $job 2>/dev/null || break
  sleep 0.1
done
kill -KILL -- -$job 2>/dev/null
wait $job
code=$?
[[ $code -eq 130 && $(wc -l <"$scratch/starts") -eq 1 ]] && pass || fail "run_forever.sh after SIGINT: exit code $code"
finish
