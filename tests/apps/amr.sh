#!/usr/bin/env bash
# amr.sh BIN: the same result_hash on every machine, with balancing and without; mass that changes is found; the cases at
# the edge hold; and what is refused.
source "$(dirname "$0")/../support/checks.sh"
bin=$1/amr
limit=100

work=("$bin" --cells 4 --steps 10 --max-level 4)
"${work[@]}" --pes 1 --json "$scratch/first.json" >/dev/null || fail "amr"
hash=$(sed -n 's/.*"result_hash": "\([0-9a-f]*\)".*/\1/p' "$scratch/first.json")
[[ -n $hash ]] || fail "no result_hash"
grep -q '"mass_change_quanta": 0' "$scratch/first.json" && pass || fail "the mass"
for balance in "" "--balance greedy_refine" "--balance hilbert" "--balance rotate"; do
  exits 0 "result_hash $hash" "${work[@]}" --pes 2 $balance
  exits 0 "result_hash $hash" "${work[@]}" --sim pes=33 $balance
  exits 0 "result_hash $hash" "${work[@]}" --sim pes=5,cost=100ns,seed=7 $balance
  exits 0 "result_hash $hash" "${mpirun[@]}" -n 2 "${work[@]}" --pes 1 $balance
done
exits 0 "result_hash $hash" "${mpirun[@]}" -n 3 "${work[@]}" --pes 2 --balance random

exits 0 "23 cases, 0 failed" "$bin" --stability --pes 2
exits 1 "23 cases, 13 failed" "$bin" --stability --uncorrected --pes 2
exits 1 "the mass changed by" "$bin" --steps 4 --uncorrected --pes 1

exits 0 "order" "$bin" --study --max-level 3 --cells 4 --pes 2 --json "$scratch/study.json" --plot "$scratch/study.svg"
[[ $(grep -c result_hash "$scratch/study.json") -eq 7 && -s $scratch/study.csv ]] && pass || fail "the study"

exits 2 "unstable above 1" "$bin" --cfl 1.01
exits 2 "--cfl" "$bin" --cfl 0
exits 2 "even number" "$bin" --cells 7
exits 2 "--max-level" "$bin" --max-level 1
exits 2 "--max-level" "$bin" --max-level 9
exits 2 "--order" "$bin" --order 4
exits 2 "--velocity" "$bin" --velocity 0,0,0
exits 2 "--velocity" "$bin" --velocity 1,1
exits 2 "--time 1" "$bin" --steps 5 --time 1
exits 2 "gredy" "$bin" --balance gredy
exits 2 "periodic" "$bin" --balance greedy,when=periodic,period=1s
exits 2 "needs --study" "$bin" --plot "$scratch/x.svg"
exits 2 "would overwrite --json" "$bin" --study --json "$scratch/x.csv" --plot "$scratch/x.svg"
exits 2 "would overwrite --trace" "$bin" --trace "$scratch/x.json" --json "$scratch/x.json"
exits 2 "does not work with" "$bin" --study --stability
exits 2 "--json" "$bin" --json "$scratch/missing/x.json"
exits 2 "--nonsense" "${mpirun[@]}" -n 2 "$bin" --nonsense
exits 0 "--sim" "$bin" --help

finish
