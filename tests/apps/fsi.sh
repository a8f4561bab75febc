#!/usr/bin/env bash
# fsi.sh BIN: the same result_hash for every cut, machine and balancer; no force is lost between the meshes; second order; the
# cases at the edge hold; it restarts; and what is refused.
source "$(dirname "$0")/../support/checks.sh"
bin=$1/fsi

work=("$bin" --panel 8 --steps 12)
"${work[@]}" --pes 1 --pieces 1 --json "$scratch/first.json" >/dev/null || fail "fsi"
hash=$(sed -n 's/.*"result_hash": "\([0-9a-f]*\)".*/\1/p' "$scratch/first.json")
[[ -n $hash ]] || fail "no result_hash"
exits 0 "result_hash $hash" "${work[@]}" --pes 2 --pieces 9
exits 0 "result_hash $hash" "${work[@]}" --sim pes=5,cost=100ns,seed=7,migrate=0.05 --pieces 4
exits 0 "result_hash $hash" "${work[@]}" --pes 2 --pieces 6 --balance rotate --balance-every 2
exits 0 "result_hash $hash" "${mpirun[@]}" -n 2 "${work[@]}" --pes 1 --balance greedy_refine

exits 0 "order" "$bin" --study --panel 16 --steps 50 --pes 2 --json "$scratch/study.json" --plot "$scratch/study.svg"
[[ $(grep -c result_hash "$scratch/study.json") -eq 6 && -s $scratch/study.csv ]] && pass || fail "the study"
orders=$(sed -n 's/^order \([0-9.]*\).*/\1/p' "$scratch/out")
[[ $orders =~ ^1\.[89]|^2\.[0-3] ]] && pass || fail "not second order: $orders"
exits 0 "12 cases, 0 failed" "$bin" --stability --pes 2
exits 1 "did not agree" "$bin" --panel 8 --density 500 --no-aitken --pes 1

saved=$scratch/saved
exits 0 "" "$bin" --panel 8 --steps 7 --pieces 4 --pes 2 --checkpoint "$saved" --checkpoint-every 5
exits 0 "result_hash $hash" "${mpirun[@]}" -n 2 "$bin" --pes 1 --steps 12 --restart "$saved"

exits 2 "at most one piece per row" "$bin" --panel 4 --pieces 9
exits 2 "give at least" "$bin" --substeps 1
exits 2 "more --per-period" "$bin" --mass 1e-30
exits 2 "--balance-every 3 .* --balance" "$bin" --balance-every 3
exits 2 "--density" "$bin" --density -1

finish
