#!/usr/bin/env bash
# stencil.sh BIN: the stencil stops and restarts on other machines, with the result of a run that never stopped; a damaged
# checkpoint is refused by name; a run that dies is started again by run_forever.sh.
source "$(dirname "$0")/../../support/checks.sh"
stencil=$1/stencil
root=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$scratch/saved

# runs COMMAND…: exit code 0.
runs() {
  timeout 100 "$@" >"$scratch/out" 2>&1 && pass && return
  fail "$*"
  tail -5 "$scratch/out"
}
# refuses PATTERN COMMAND…: exit code 2, and one line that matches.
refuses() {
  local pattern=$1
  shift
  timeout 100 "$@" >"$scratch/out" 2>&1
  local code=$?
  if ((code == 2)) && grep -Eq -- "$pattern" "$scratch/out"; then
    pass
  else
    fail "$* (exit code $code) does not refuse '$pattern'"
    tail -5 "$scratch/out"
  fi
}
same_result() {
  same_results "$scratch/want.json" "$scratch/result.json" && pass && return
  fail "another result: $1"
  cat "$scratch/want.json" "$scratch/result.json"
}

runs "$stencil" --size 48 --steps 400 --pes 2 --json "$scratch/want.json"
grep -q '"result_hash"' "$scratch/want.json" && pass || fail "no key result_hash"

# Four threads, two ranks, seven simulated PEs, one PE.
often=(--checkpoint "$folder" --checkpoint-every 90)
runs "$stencil" --size 48 --steps 200 --pes 4 "${often[@]}"
runs "${mpirun[@]}" -n 2 "$stencil" --steps 300 --pes 1 "${often[@]}" --restart "$folder"
says '^continues after step 180$'
runs "$stencil" --steps 380 --sim pes=7,cost=100ns,seed=5 "${often[@]}" --restart "$folder"
says '^continues after step 270$'
runs "$stencil" --steps 400 --pes 1 --restart "$folder" --json "$scratch/result.json"
says '^continues after step 360$'
same_result "threads, mpi, simulated, one PE"
runs "${mpirun[@]}" -n 3 "$stencil" --steps 400 --pes 2 --restart "$folder" --json "$scratch/result.json"
same_result "one more restart, on three ranks"

# One that is due at the last step; nothing is left to do, or more.
runs "$stencil" --size 48 --steps 180 --pes 2 --checkpoint "$scratch/due" --checkpoint-every 90
runs "$stencil" --restart "$scratch/due" --pes 2
says '^continues after step 180$'
runs "$stencil" --restart "$scratch/due" --steps 400 --pes 3 --json "$scratch/result.json"
same_result "after a checkpoint of the last step"

# By time: a checkpoint at each pause.
runs "$stencil" --size 48 --steps 20 --pes 2 --checkpoint "$scratch/timed" --checkpoint-every 0.000001s
runs "$stencil" --restart "$scratch/timed" --steps 400 --pes 2 --json "$scratch/result.json"
same_result "checkpoints by time"

# Damaged: the one before is used, with a line that says so.
latest=$(find "$folder" -maxdepth 1 -name 'checkpoint-*' | sort | tail -1)
truncate -s -1 "$latest/pe-3"
runs "$stencil" --steps 400 --pes 2 --restart "$folder" --json "$scratch/result.json"
says "a checkpoint is refused: .*/${latest##*/}/pe-3 has [0-9]* bytes, but the manifest says .*; the one before is used"
says '^continues after step 270$'
same_result "after a damaged checkpoint"

refuses "--checkpoint $folder: holds $latest of another run: continue that with --restart $folder, or give" "$stencil" --pes 2 "${often[@]}"
refuses 'holds .* of another run' "$stencil" --pes 2 --restart "$scratch/timed" "${often[@]}"
refuses 'holds .* of another run' "${mpirun[@]}" -n 2 "$stencil" --pes 1 "${often[@]}"
refuses 'nothing: no checkpoint is in this folder' "$stencil" --restart "$scratch/nothing" --pes 2
refuses '--size: 64, but the checkpoint has 48' "$stencil" --restart "$folder" --size 64 --pes 2
refuses '--steps: 10, but the checkpoint has done 270' "$stencil" --restart "$folder" --steps 10 --pes 2
for bad in 0 -3 2.5 x 10m s ''; do
  refuses "--checkpoint-every" "$stencil" --pes 1 --steps 1 --checkpoint "$scratch/bad" --checkpoint-every "$bad"
done
refuses 'cannot be made' "$stencil" --pes 1 --steps 3 --checkpoint /proc/none --checkpoint-every 1

# A run that is killed again and again ends with the same result.
cat >"$scratch/dies" <<END
#!/usr/bin/env bash
# The stencil; each of the first three runs is killed once it has written a new checkpoint.
n=\$(ls -d "$scratch/forever"/*/manifest.json 2>/dev/null | tail -1)
"$stencil" "\$@" &
child=\$!
if [[ ! -e "$scratch/third" ]]; then
  if [[ -e "$scratch/second" ]]; then touch "$scratch/third"; elif [[ -e "$scratch/first" ]]; then touch "$scratch/second"; else touch "$scratch/first"; fi
  while kill -0 \$child 2>/dev/null && [[ \$(ls -d "$scratch/forever"/*/manifest.json 2>/dev/null | tail -1) == "\$n" ]]; do sleep 0.01; done
  sleep 0.02
  kill -9 \$child
fi
wait \$child
END
chmod +x "$scratch/dies"
runs "$stencil" --size 300 --steps 2400 --pes 2 --json "$scratch/want.json"
runs bash "$root/apps/run_forever.sh" "$scratch/forever" "$scratch/dies" --size 300 --steps 2400 --pes 2 --checkpoint-every 200 --json "$scratch/result.json"
says 'ended with exit code 137; it is started again from checkpoint-'
same_result "run_forever.sh"
refuses 'unknown|not expected' bash "$root/apps/run_forever.sh" "$scratch/never" "$stencil" --pes 1 --no-such-option
finish
