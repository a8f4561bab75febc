#!/usr/bin/env bash
# nqueens.sh BIN: the known counts, the same result_hash on every machine, and what is refused.
source "$(dirname "$0")/../support/checks.sh"
bin=$1/nqueens

for n in {1..13} 15; do exits 0 "path" "$bin" "$n" --pes 2; done

hash_of() { grep -o '"result_hash": "[0-9a-f]*"' "$1"; }
# same COMMAND…: the command gives the hash of `want`.
same() {
  rm -f "$scratch/again.json"
  exits 0 "path\|none" "$@" --json "$scratch/again.json"
  [[ $(hash_of "$scratch/again.json") == "$want" ]] && pass || fail "another hash: $*"
}
for task in "11" "16 --first"; do
  "$bin" $task --pes 1 --json "$scratch/first.json" >/dev/null || fail "nqueens $task"
  want=$(hash_of "$scratch/first.json")
  [[ -n $want ]] || fail "no hash"
  for form in group chares; do
    for priority in path none; do
      all=("$bin" $task --form $form --priority $priority --grain 13)
      same "${all[@]}" --pes 2
      same "${all[@]}" --sim pes=64
      same "${all[@]}" --sim pes=7,cost=100ns,seed=5
      same "${mpirun[@]}" -n 2 "${all[@]}" --pes 1
    done
  done
done

# The study: both forms, all grains, efficiencies, a picture.
exits 0 chares "$bin" 8 --study --sim pes=4 --json "$scratch/study.json" --plot "$scratch/study.svg"
[[ $(grep -c '"efficiency"' "$scratch/study.json") -eq 16 && -s $scratch/study.csv ]] && pass || fail "the study"

# A wrong count is found.
exits 1 "have 5 solutions, found 92" "$bin" 8 --expect 5 --pes 2
exits 1 "have 0 solutions, but one was found" "$bin" 8 --first --expect 0 --sim pes=3

exits 2 "N" "$bin" 0
exits 2 "N" "$bin" 21
exits 2 "--grain" "$bin" 20 --grain 5
exits 2 "--grain" "$bin" 8 --grain 0
exits 2 "--form" "$bin" 8 --form tree
exits 2 "--priority" "$bin" 8 --priority 3
exits 2 "--study" "$bin" 8 --study --first
exits 2 "needs --study" "$bin" 8 --plot "$scratch/x.svg"
exits 2 "would overwrite --json" "$bin" 8 --study --json "$scratch/x.svg" --plot "$scratch/x.svg"
exits 2 ".svg" "$bin" 8 --study --plot "$scratch/x.png"
exits 2 "--json" "$bin" 8 --json "$scratch/missing/x.json"
exits 2 "--nonsense" "${mpirun[@]}" -n 2 "$bin" 8 --nonsense
exits 0 "--sim" "$bin" --help

finish
