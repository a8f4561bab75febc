#!/usr/bin/env bash
# task_bench.sh BIN: runs task_bench with every type and kernel, with its inputs checked, on threads, under mpirun and in
# adversarial order. It finds a wrong input. METG and balancing give the results that follow from the cost model of the
# simulated machine.
source "$(dirname "$0")/../support/checks.sh"
bin=$1/task_bench

# ok TEXT COMMAND…: requires exit code 0, and the text in the output.
ok() {
  local want=$1
  shift
  timeout 60 "$@" >"$scratch/out" 2>"$scratch/err"
  local code=$?
  if [[ $code -eq 0 ]] && grep -q -- "$want" "$scratch/out"; then
    pass
  else
    fail "(exit $code, wanted \"$want\"): $*"
    tail -3 "$scratch/out" "$scratch/err"
  fi
}
# fails CODE TEXT COMMAND…: requires this exit code, and one line of error with the text.
fails() {
  local want_code=$1 want=$2
  shift 2
  timeout 60 "$@" >"$scratch/out" 2>"$scratch/err"
  local code=$?
  if [[ $code -eq $want_code ]] && grep -q -- "$want" "$scratch/err" &&
    { [[ $want_code -ne 2 ]] || [[ $(wc -l <"$scratch/err") -eq 1 ]]; }; then
    pass
  else
    fail "(exit $code, wanted $want_code and \"$want\"): $*"
    cat "$scratch/err"
  fi
}

types=(trivial no_comm stencil_1d stencil_1d_periodic dom tree fft all_to_all nearest spread random_nearest)
kernels=(empty busy_wait memory_bound compute_bound load_imbalance)
checked="every input was checked"
for type in "${types[@]}"; do
  for kernel in "${kernels[@]}"; do
    extra=()
    [[ $kernel == memory_bound ]] && extra=(-scratch 4096)
    [[ $kernel == load_imbalance ]] && extra=(-imbalance 1)
    for pes in 1 3; do
      ok "$checked" "$bin" -steps 23 -width 11 -type "$type" -kernel "$kernel" -iter 20 "${extra[@]}" --pes $pes
    done
  done
  for seed in 1 2 3 4 5 6; do
    ok "$checked" "$bin" -steps 23 -width 11 -type "$type" --sim pes=4,cost=100ns,seed=$seed --repeat 2
    ok "$checked" "$bin" -steps 23 -width 11 -type "$type" -output 100 --sim pes=3,cost=100ns,seed=$seed \
      --balance random --balance-every 4
  done
done
many=()
for type in "${types[@]}"; do many+=(-steps 20 -width 9 -type "$type" -output $((16 + ${#type})) -and); done
ok "$checked" "${mpirun[@]}" -n 2 "$bin" "${many[@]}" -steps 5 --pes 1
ok "$checked" "${mpirun[@]}" -n 2 "$bin" "${many[@]}" -steps 5 --pes 2 --balance greedy --balance-every 5
ok "$checked" "$bin" "${many[@]}" -steps 5 --pes 2 --repeat 3
ok "Total Tasks 600" "$bin" -steps 10 -width 20 -and -steps 20 -width 20 -type fft --pes 2
ok "Total Dependencies 522" "$bin" -steps 10 -width 20 -type stencil_1d --pes 2

# The consumer of a wrong output reports it.
for type in stencil_1d stencil_1d_periodic dom tree fft all_to_all nearest spread; do
  fails 1 "wrong input" "$bin" -steps 20 -width 8 -type $type --spoil 12,3 --pes 2
done
fails 1 "wrong input" "$bin" -steps 20 -width 8 -type stencil_1d -output 64 --spoil 12,4 --sim pes=3
fails 1 "wrong input" "${mpirun[@]}" -n 2 "$bin" -steps 20 -width 8 -type fft --spoil 12,4 --pes 1

# With -type all the types after the first have the task, and those whose period does not fit are found before anything runs.
fails 1 "wrong input" "$bin" -metg -type all -steps 20 --spoil 12,3 --pes 2
fails 2 "no graph has a task" "$bin" -metg -type all -steps 20 --spoil 19,3 --pes 2
fails 2 "at most 1 for spread" "$bin" -metg -type all -width 4 -radix 4 --pes 2

# The iterations that were run count, not those that were asked for: what is not kernels is the cost of messages, at every
# grain the same.
"$bin" -metg -type trivial -steps 200 -kernel load_imbalance -imbalance 2 -persistent --repeat 1 --sim pes=1,cost=100ns \
  --json "$scratch/drawn.json" >"$scratch/out" 2>&1
python3 - "$scratch/drawn.json" <<'PYTHON' && pass || fail "efficiency of drawn iterations"
import json, sys
(result,) = json.load(open(sys.argv[1]))["results"]
rows = result["grains"]
assert len(rows) > 3, rows
rest = [row["seconds"] * (1 - row["efficiency"]) for row in rows]
for row, one in zip(rows, rest):
    assert row["efficiency"] < 1 and abs(one - rest[0]) < 0.01 * rest[0] + 1e-5 * row["seconds"], (rows, rest)
PYTHON

# Virtual time is exact: 100 ns per message, with one message per task of trivial and two of stencil_1d.
"$bin" -metg -type all -steps 200 --sim pes=4,cost=100ns,latency=0us --repeat 1 --json "$scratch/m.json" \
  --csv "$scratch/rows.csv" --plot "$scratch/m.svg" >"$scratch/out" 2>&1
python3 - "$scratch/m.json" "$scratch/rows.csv" <<'PYTHON' && pass || fail "the rows"
import csv, json, sys
results = json.load(open(sys.argv[1]))["results"]
metg = {one["type"]: one["metg_us"] for one in results}
assert len(metg) == 11, metg
assert 0.095 < metg["trivial"] < 0.11, metg
assert 0.095 < metg["no_comm"] < 0.11, metg
assert 0.19 < metg["stencil_1d"] < 0.21, metg
for one in results:
    assert one["pes"] == 4 and one["ranks"] == 1 and one["width"] == 64 and one["grains"], one
    assert all(set(row) >= {"iterations", "grain_us", "seconds", "efficiency"} for row in one["grains"])
rows = list(csv.DictReader(open(sys.argv[2])))
assert len(rows) == sum(len(one["grains"]) for one in results)
PYTHON
[[ -s $scratch/m.csv ]] || fail "no m.csv"
fails 2 "would overwrite --json" "$bin" --json "$scratch/x.csv" --plot "$scratch/x.svg"
fails 2 "would overwrite --json" "$bin" --json "$scratch/x.csv" --csv "$scratch/x.csv"

# Persistent imbalance with four columns per PE: greedy_refine removes it. The times of the simulated machine are exact.
seconds_of() { timeout 60 "$@" | sed -n 's/^Elapsed Time \(.*\) seconds/\1/p'; }
work=("$bin" -type nearest -steps 200 -width 64 -kernel load_imbalance -imbalance 2 -persistent -iter 2500
  --sim pes=4,cost=100ns)
plain=$(seconds_of "${work[@]}")
balanced=$(seconds_of "${work[@]}" --balance greedy_refine --balance-every 20)
if python3 -c "import sys; sys.exit(0 if $balanced < 0.97 * $plain else 1)"; then
  pass
else
  fail "balanced $balanced s, without $plain s"
fi

fails 2 "-nonsense" "$bin" -nonsense
fails 2 "--steps" "$bin" --steps 5
fails 2 "-steps" "$bin" -steps
fails 2 "-steps 0" "$bin" -steps 0
fails 2 "-width x" "$bin" -width x
fails 2 "torus" "$bin" -type torus
fails 2 "gemm" "$bin" -kernel gemm
fails 2 "-type all" "$bin" -type all
fails 2 "-period" "$bin" -type fft -period 3
fails 2 "at most 2" "$bin" -type spread -width 4 -radix 2
fails 2 "-scratch" "$bin" -kernel memory_bound -iter 3
fails 2 "-output 8" "$bin" -output 8
fails 2 "-imbalance 3" "$bin" -kernel load_imbalance -imbalance 3
fails 2 "-fraction" "$bin" -fraction 1.5
fails 2 "no grain" "$bin" -metg -kernel empty
fails 2 "leave -iter out" "$bin" -metg -iter 100
fails 2 "--balance-every" "$bin" --balance-every 5
fails 2 "--balance-every" "$bin" --balance greedy,when=periodic,period=1ms --balance-every 5
fails 2 "gredy" "$bin" --balance gredy
fails 2 "--spoil" "$bin" --spoil 3
fails 2 "no graph has a task" "$bin" -steps 4 -width 4 --spoil 4,0
fails 2 "no graph has a task" "$bin" -steps 4 -width 4 -type trivial --spoil 2,2
fails 2 "no graph has a task" "$bin" -steps 4 -width 4 -type tree --spoil 0,1
fails 2 "missing" "$bin" --json "$scratch/missing/x.json"
fails 2 "--plot" "$bin" --csv "$scratch/x.csv" --plot "$scratch/x.svg"
fails 2 ".svg" "$bin" --plot "$scratch/x.png"
fails 2 "-nonsense" "${mpirun[@]}" -n 2 "$bin" -nonsense
ok "-imbalance" "$bin" --help
ok "--sim" "$bin" -h
ok "no barrier" "$bin" --explain

finish
