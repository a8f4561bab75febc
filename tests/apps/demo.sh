#!/usr/bin/env bash
# demo.sh BIN DEMO: runs the demo on small meshes, and checks its answers: the same result under mpirun, second order, and
# every file that it says it writes.
set -uo pipefail
bin=$1 demo=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

if ! bash "$demo" --quick --built "$bin" --into "$scratch/demo" >"$scratch/out" 2>&1; then
  echo "FAILED: the demo ends with an error:"
  tail -20 "$scratch/out"
  exit 1
fi
python3 - "$scratch/demo" "$scratch/out" <<'PYTHON'
import json, os, sys
folder, log = sys.argv[1], open(sys.argv[2]).read()
def read(name):
    return json.load(open(os.path.join(folder, name)))
pairs = [read(name)["results"][0] for name in ("result.json", "result_1.json", "result_2.json")]
assert [pair["processes"] for pair in pairs] == [1, 1, 2], "processes"
assert len({pair["result_hash"] for pair in pairs}) == 1, f"hashes differ: {[p['result_hash'] for p in pairs]}"
for pair in pairs:
    assert pair["outside"] == 0 and pair["inside"] > 0.4 * pair["targets"], pair
    assert 0 < pair["l2_relative"] < 0.1, pair["l2_relative"]
study = read("study/study.json")
assert len(study["results"]) == 3, "rows of the study"
order = study["trends"][0]["l2_of_edge"]
assert 1.7 < order < 2.3, f"order {order}"
for name in ("result.exo", "result.svg", "result.txt", "study.txt", "study/error_time.csv", "study/error_edge.csv", "study/study.csv"):
    assert os.path.getsize(os.path.join(folder, name)) > 100, name
assert f"on threads, one rank and two ranks: hash {pairs[0]['result_hash']}" in log, log
assert f"L2 error ~ edge^{order:.2f}" in log, log
assert len(log.splitlines()) <= 14, log
print(f"demo: one hash in three runs, order {order:.2f}")
PYTHON
code=$?
((code == 0)) || tail -20 "$scratch/out"
bash "$demo" --nonsense >/dev/null 2>"$scratch/err"
if [[ $? -ne 2 ]] || ! grep -q usage "$scratch/err"; then
  echo "FAILED: the demo accepts --nonsense"
  code=1
fi
bash "$demo" --into >/dev/null 2>"$scratch/err"
if [[ $? -ne 2 ]] || ! grep -q usage "$scratch/err"; then
  echo "FAILED: the demo accepts --into without a folder"
  code=1
fi
# A folder is relative to where the demo is started. What it would install, build and mesh with is replaced.
mkdir -p "$scratch/tree/apps" "$scratch/tree/cmake" "$scratch/fake"
cp "$demo" "$scratch/tree/apps/demo.sh"
: >"$scratch/tree/cmake/setup.sh"
printf '#!/bin/sh\n' >"$scratch/fake/cmake"
printf '#!/bin/sh\nexit 1\n' >"$scratch/fake/gmsh"
chmod +x "$scratch"/fake/*
(cd "$scratch" && PATH=$scratch/fake:$PATH bash tree/apps/demo.sh --into results >"$scratch/out" 2>&1)
if [[ ! -d $scratch/results || -e $scratch/tree/results ]]; then
  echo "FAILED: --into results is not below the working folder"
  code=1
fi
exit $code
