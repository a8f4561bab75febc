#!/usr/bin/env bash
# leanmd.sh BIN: one hash on threads, under mpirun and on the simulated machine, with and without balancing; the study's
# order; what is refused, and what is found unstable.
source "$(dirname "$0")/../support/checks.sh"
leanmd=$1/leanmd
case=(--atoms 600 --density 0.6 --cells 3,2,3 --steps 15 --exchange 4 --every 5 --gradient 1)

# same COMMAND…: the program ends well, and its hash is that of the first run.
same() {
  rm -f "$scratch/run.json"
  if timeout 60 "$@" --json "$scratch/run.json" >"$scratch/out" 2>&1 &&
    grep '"result_hash": "[0-9a-f]\{16\}"' "$scratch/run.json" >"$scratch/hash"; then
    [[ -e $scratch/first ]] || cp "$scratch/hash" "$scratch/first"
    if cmp -s "$scratch/first" "$scratch/hash"; then
      pass
      return
    fi
  fi
  fail "$*"
  tail -3 "$scratch/out"
}
# fails CODE TEXT OPTIONS…: requires this exit code, and one line of error with the text.
fails() {
  local want_code=$1 want=$2
  shift 2
  timeout 60 "$leanmd" "$@" >"$scratch/out" 2>"$scratch/err"
  local code=$?
  if [[ $code -eq $want_code && $(wc -l <"$scratch/err") -eq 1 ]] && grep -q -- "$want" "$scratch/err"; then
    pass
  else
    fail "(exit $code, wanted $want_code and \"$want\"): $*"
    cat "$scratch/err"
  fi
}

same "$leanmd" "${case[@]}" --pes 1 --check --reverse
same "$leanmd" "${case[@]}" --pes 2
same "$leanmd" "${case[@]}" --pes 2 --balance greedy
same "$leanmd" "${case[@]}" --pes 3 --balance random,when=periodic,period=2ms
for seed in 1 2 3; do
  same "$leanmd" "${case[@]}" --sim "pes=7,cost=100ns,seed=$seed"
  same "$leanmd" "${case[@]}" --sim "pes=7,cost=100ns,seed=$seed,migrate=0.1" --balance greedy_refine --check
done
same "${mpirun[@]}" -n 2 "$leanmd" "${case[@]}" --pes 1
same "${mpirun[@]}" -n 2 "$leanmd" "${case[@]}" --pes 2 --balance rotate --check
other=$(timeout 60 "$leanmd" "${case[@]}" --seed 2 --json "$scratch/other.json" >/dev/null && sed -n 's/.*"result_hash": //p' "$scratch/other.json")
[[ -n $other && $(sed 's/.*: //' "$scratch/first") != "$other" ]] && pass || fail "another seed has the same hash"

timeout 60 "$leanmd" --study --atoms 300 --cells 2,2,2 --steps 20 --pes 2 --json "$scratch/study.json" --plot "$scratch/study.svg" >"$scratch/out" 2>&1
python3 -c '
import json, sys
study = json.load(open(sys.argv[1]))
assert 1.9 < study["fitted_order"] < 2.1, study
assert len(study["results"]) == 5 and all(row["seconds"] > 0 for row in study["results"]), study' "$scratch/study.json" && [[ -s $scratch/study.csv ]] &&
  pass || fail "the study"

# A study of which no row is stable has no picture, and says so.
exits 0 "x.svg: not drawn" "$leanmd" --study --dt 0.5 --atoms 300 --cells 2,2,2 --steps 8 --pes 1 --plot "$scratch/x.svg"

# What a balancer does.
exits 0 "greedy every 20 steps" "$leanmd" --atoms 300 --cells 2,2,2 --steps 0 --pes 1 --balance greedy --explain
exits 0 "greedy; every 20 steps a barrier, and a round if it pays off" \
  "$leanmd" --atoms 300 --cells 2,2,2 --steps 0 --pes 1 --balance greedy,when=automatic --explain
exits 0 "greedy every 2.5 ms, beside the steps" \
  "$leanmd" --atoms 300 --cells 2,2,2 --steps 0 --pes 1 --balance greedy,when=periodic,period=2500us --explain

# With a fixed cost the times of the simulated machine are exact: balancing gains over a fifth.
seconds_of() {
  timeout 60 "$leanmd" --atoms 2000 --cells 4,4,4 --gradient 1 --steps 30 --every 6 --sim pes=4,cost=500ns --json "$scratch/time.json" "$@" >/dev/null
  sed -n 's/.*"seconds": \([^,]*\),/\1/p' "$scratch/time.json" | head -1
}
plain=$(seconds_of)
balanced=$(seconds_of --balance greedy_refine)
python3 -c "import sys; sys.exit(0 if $balanced < 0.8 * $plain else 1)" && pass || fail "balanced $balanced s, without $plain s"

fails 1 "lower --" "${case[@]}" --dt 0.1
fails 1 "unstable until" --atoms 400 --density 0.55 --gradient 0 --cells 3,3,3 --exchange 1 --steps 60 --dt 0.03
fails 2 "--cells: 0" --cells 0,1,1
fails 2 "--cells" --cells 2,2
fails 2 "give fewer cells" --cells 90,1,1
fails 2 "--atoms" --atoms 0
fails 2 "--dt: nan" --dt nan
fails 2 "half of the box" --cutoff 12
fails 2 "--gradient: 2" --gradient 2
fails 2 "gredy" --balance gredy
fails 2 "missing" --json "$scratch/missing/x.json"
fails 2 "needs --study" --plot "$scratch/x.svg"
fails 2 "--study" --study --dt 0.9
fails 2 "would overwrite --json" --study --json "$scratch/x.csv" --plot "$scratch/x.svg"
fails 2 "would overwrite --trace" --trace "$scratch/x.json" --json "$scratch/x.json"
fails 2 "does not work with --stability" --stability --explain
fails 2 "does not work with --study" --study --explain
timeout 60 "$leanmd" --stability --pes 1 >"$scratch/out" 2>&1 && grep -q " 0 failed" "$scratch/out" && pass || fail "--stability"

finish
