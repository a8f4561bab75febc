#!/usr/bin/env bash
# kill.sh BIN [TIMES]: kills the stencil at random moments while it writes checkpoints, and restarts it. Never is more lost
# than one interval, and the result is that of a run that was not killed. By default 5 times; by hand: kill.sh BIN 200.
source "$(dirname "$0")/../../support/checks.sh"
stencil=$1/stencil
times=${2:-5}
what=(--size 512 --steps 400 --pes 2)
folder=$scratch/saved
timeout 200 "$stencil" "${what[@]}" --json "$scratch/want.json" >"$scratch/out" || fail "the run that is not killed"

# Numbers of checkpoints: begun, and finished.
begun() { ls "$folder" 2>/dev/null | sed 's/^checkpoint-0*//' | sort -n | tail -1; }
for ((i = 0; i < times; ++i)); do
  rm -rf "$folder"
  "$stencil" "${what[@]}" --checkpoint "$folder" --checkpoint-every 10 >/dev/null 2>&1 &
  child=$!
  # A random moment of the writing: after a random checkpoint was begun, and a random short time.
  target=$((RANDOM % 12 + 2))
  while kill -0 $child 2>/dev/null && (($(begun || echo 0) + 0 < target)); do sleep 0.001; done
  sleep "0.0$((RANDOM % 3))$((RANDOM % 10))"
  kill -9 $child 2>/dev/null && n_killed=$((${n_killed:-0} + 1))
  wait $child 2>/dev/null
  last=$(begun)
  timeout 200 "$stencil" --steps 400 --pes $((RANDOM % 4 + 1)) --restart "$folder" --json "$scratch/result.json" >"$scratch/out" 2>&1
  code=$?
  step=$(sed -n 's/^continues after step //p' "$scratch/out")
  [[ -e "$folder/checkpoint-$(printf %06d "$last")/manifest.json" ]] || n_unfinished=$((${n_unfinished:-0} + 1))
  if ((code == 0)) && same_results "$scratch/want.json" "$scratch/result.json" && ((step >= 10 * (last - 1))); then
    pass
  else
    fail "time $i: exit code $code, checkpoint $last was begun, the run continued after step '$step'"
    tail -3 "$scratch/out"
  fi
done
((${n_killed:-0} > 0)) && pass || fail "nothing was killed"
echo "killed ${n_killed:-0} times, ${n_unfinished:-0} times while a checkpoint was being written"
finish
