#!/usr/bin/env bash
# random.sh BIN [TIMES [SEED]]: stencil, leanmd, amr and nqueens in turn run on 4 threads, restart on 2 ranks, on 7 simulated
# PEs, and on one PE to the end. The first three are killed at random moments. The result_hash is that of a run that was
# not killed. By default 4 times; by hand: random.sh BIN 200.
source "$(dirname "$0")/../../support/checks.sh"
bin=$1
times=${2:-4}
RANDOM=${3:-$$}
folder=$scratch/saved
problems=(
  "stencil --size 256 --steps 400"
  "leanmd --atoms 600 --density 0.6 --cells 3,2,3 --exchange 4 --every 5 --gradient 1 --steps 120"
  "amr --cells 4 --max-level 4 --change-every 3 --steps 60"
  "nqueens 14"
)
# Of a program: what may differ from leg to leg. Each has one choice more, nothing.
free_options=("" "--balance greedy;--balance rotate;--balance random,when=periodic,period=3ms" "--balance greedy_refine;--balance rotate" "--form chares;--priority none")
# Of a program: the least and the greatest --checkpoint-every.
least=(4 2 1 15)
most=(40 20 10 120)

hash_of() { grep -o '"result_hash": "[0-9a-f]*"' "$scratch/run.json"; }
# Numbers of checkpoints: the last that was begun.
begun() { ls "$folder" 2>/dev/null | sed 's/^checkpoint-0*//' | sort -n | tail -1; }
has_manifest() { ls "$folder"/checkpoint-*/manifest.json >/dev/null 2>&1; }

# leg KIND SIGNAL: the program on this machine, from the last checkpoint if there is one; killed after up to three new
# checkpoints were begun and a random short time, unless it ends before.
n_legs=0 n_killed=0 n_writing=0
leg() {
  local target=$(($(begun || echo 0) + 1 + RANDOM % 3)) options choices child last
  IFS=';' read -ra choices <<<"${free_options[which]}"
  options=${choices[RANDOM % (${#choices[@]} + 1)]:-}
  $1 $problem $options --checkpoint "$folder" --checkpoint-every $((least[which] + RANDOM % (most[which] - least[which] + 1))) \
    $(has_manifest && echo "--restart $folder") >"$scratch/leg" 2>&1 &
  child=$!
  while kill -0 $child 2>/dev/null && (($(begun || echo 0) + 0 < target)); do sleep 0.001; done
  sleep "0.0$((RANDOM % 4))$((RANDOM % 10))"
  # The ranks and not mpirun: Open MPI's mpirun may crash when SIGTERM meets its own end.
  if [[ $2 == TERM ]]; then kill -TERM $(pgrep -P $child) 2>/dev/null; else kill -KILL $child 2>/dev/null; fi
  wait $child 2>/dev/null
  local code=$?
  n_legs=$((n_legs + 1))
  ((code == 0)) && return
  # mpirun may end with 1 where a rank ends with 143.
  if [[ $2 == KILL && $code -ne 137 || $2 == TERM && $code -ne 143 && $code -ne 1 ]] || grep -q 'wrong answer\|deadlock\|expected\|uncaught exception\|error: ' "$scratch/leg"; then
    fail "time $i: exit code $code: $1 $problem $options"
    head -40 "$scratch/leg"
  fi
  n_killed=$((n_killed + 1))
  last=$(begun)
  [[ -z $last || -e "$folder/checkpoint-$(printf %06d "$last")/manifest.json" ]] || n_writing=$((n_writing + 1))
}
on_threads() { exec "$bin/$@" --pes 4; }
on_ranks() { exec "${mpirun[@]}" -n 2 "$bin/$@" --pes 1; }
on_simulated() { exec "$bin/$@" --sim "pes=7,cost=100ns,seed=$RANDOM"; }

declare -A want
for problem in "${problems[@]}"; do
  timeout 200 "$bin"/$problem --pes 2 --json "$scratch/run.json" >"$scratch/out" 2>&1 || fail "the run that is not killed: $problem"
  want[$problem]=$(hash_of)
done
for ((i = 0; i < times; ++i)); do
  which=$((i % ${#problems[@]}))
  problem=${problems[which]}
  rm -rf "$folder" "$scratch/run.json"
  leg on_threads KILL
  leg on_ranks TERM
  leg on_simulated KILL
  has_manifest && restart="--restart $folder" || restart=
  timeout 200 "$bin"/$problem --pes 1 $restart --json "$scratch/run.json" >"$scratch/out" 2>&1
  code=$?
  if ((code == 0)) && [[ -n ${want[$problem]} && $(hash_of) == "${want[$problem]}" ]] &&
    { [[ -z $restart ]] || grep -q '^continues after step' "$scratch/out"; }; then
    pass
  else
    fail "time $i: exit code $code: $problem $restart"
    tail -3 "$scratch/out"
  fi
done
echo "of $n_legs runs $n_killed were killed before their end, $n_writing of them while they wrote a checkpoint"
finish
