#!/usr/bin/env bash
# examples.sh BIN: hello, ring, stencil, coupled, overset, m2m_transfer and lb_lab on threads, under mpirun and on the simulated machine, with their answers.
source "$(dirname "$0")/../support/checks.sh"
bin=$1

# check WHAT CODE: counts a result.
check() {
  if (($2 == 0)); then
    pass
  else
    fail "$1"
    tail -5 "$scratch/out"
  fi
}
# answers PATTERN COMMAND…: exit code 0, and a line that matches.
answers() {
  local pattern=$1
  shift
  timeout 60 "$@" >"$scratch/out" 2>&1 && grep -Eq -- "$pattern" "$scratch/out"
  check "$* does not answer '$pattern'" $?
}

# hello: eight elements in order, whatever the machine.
for i in 0 1 2 3 4 5 6 7; do echo "element $i: hello after $i hops"; done >"$scratch/hello"
greets() {
  timeout 60 "$@" >"$scratch/out" 2>&1 && sort "$scratch/out" | cmp -s - "$scratch/hello"
  check "$* prints something else" $?
}
greets "$bin/hello" --pes 1
greets "$bin/hello" --pes 4
greets "${mpirun[@]}" -n 2 "$bin/hello" --pes 1
greets "$bin/hello" --sim pes=5,seed=3

# ring: the program compares sum and visits with closed forms, and ends with an error otherwise.
answers '^300 hops over 3 stations: .* each met once$' "$bin/ring" --pes 3 --rounds 100
answers '^2800 hops over 7 stations: .* each met once$' "$bin/ring" --pes 2 --stations 7 --rounds 50 --messages 8
answers '^400 hops over 4 stations: .* each met once$' "${mpirun[@]}" -n 2 "$bin/ring" --pes 2 --rounds 100
answers '^600 hops over 6 stations: .* each met once$' "$bin/ring" --sim pes=6,cost=100ns,seed=2 --rounds 100

# stencil: at most 1e-12 from the exact iterate (the program checks that), and the same bits for every cut and machine.
stencil=("$bin/stencil" --size 48 --steps 400)
hash_of() { grep -o 'hash [0-9a-f]*$' "$scratch/out"; }
answers '^from the exact iterate [0-9.]+e-1[3-9], ' "${stencil[@]}" --pes 1 --blocks 1
want=$(hash_of)
same() {
  timeout 60 "$@" >"$scratch/out" 2>&1 && [[ -n $want && $(hash_of) == "$want" ]]
  check "$* has not the $want" $?
}
answers '^step 399 [0-9]+\.[0-9]{6} [0-9]+\.[0-9]{6}$' "${stencil[@]}" --pes 1 --log-steps
same "${stencil[@]}" --pes 2 --blocks 5
same "${stencil[@]}" --pes 2 --blocks 5 --repeat 3
same "${mpirun[@]}" -n 2 "${stencil[@]}" --pes 1 --blocks 4 --repeat 2
answers '^the time is the median of 3 runs, after one that warms up; [0-9.]+ to [0-9.]+ us$' "${stencil[@]}" --pes 2 --repeat 3
same "${stencil[@]}" --pes 4 --blocks 7
same "${mpirun[@]}" -n 2 "${stencil[@]}" --pes 1 --blocks 4
same "$bin/stencil" --size 48 --steps 400 --sim pes=8,cost=100ns,seed=5 --blocks 6
# Closer to the solution with every doubling of the points: second order.
distance() { "$bin/stencil" --size "$1" --steps "$2" --pes 2 | grep -o 'from the solution [0-9.e+-]*' | grep -o '[0-9.e+-]*$'; }
coarse=$(distance 7 2000) fine=$(distance 15 8000)
python3 -c "import sys; sys.exit(0 if 3.7 < $coarse / $fine < 4.3 else 1)"
check "the stencil is not second order: $coarse and $fine from the solution" $?

# coupled: the same bits for every cut and machine, and second order.
coupled=("$bin/coupled" --cubes 12)
answers 'taken [1-9][0-9]* and [1-9][0-9]*; hash' "${coupled[@]}" --pes 1 --slabs 1
want=$(hash_of)
same "${coupled[@]}" --pes 2 --slabs 5
same "${coupled[@]}" --pes 3 --slabs 9
same "${mpirun[@]}" -n 2 "${coupled[@]}" --pes 1 --slabs 4
same "${coupled[@]}" --sim pes=5,cost=100ns,seed=3 --slabs 7
# The small box moves a fifth of a cube a step, however short the time is.
answers ' 15 steps' "${coupled[@]}" --time 1e-6 --pes 2
# Slabs that migrate between transfers: the same bits, and less time where the work is unequal.
burning=("${coupled[@]}" --time 0.0015 --reaction 1000)
answers 'hash' "${burning[@]}" --pes 1 --slabs 1
want=$(hash_of)
moves() {
  timeout 60 "$@" >"$scratch/out" 2>&1 && [[ -n $want && $(hash_of) == "$want" ]] && grep -Eq ': [1-9][0-9]* slabs moved' "$scratch/out"
  check "$* has not the $want, or moves nothing" $?
}
moves "${burning[@]}" --pes 2 --slabs 6 --balance rotate
moves "${mpirun[@]}" -n 2 "${burning[@]}" --pes 2 --slabs 7 --balance rotate --balance-every 2
for seed in 1 2 3 4 5 6; do
  moves "${burning[@]}" --sim "pes=$((seed + 1)),cost=100ns,seed=$seed,migrate=0.2" --slabs $((13 - seed)) --balance random
done
virtual() { "$bin/coupled" --cubes 16 --reaction 1000 --sim pes=4,cost=500ns --slabs 16 --substeps 200 "$@" | grep -o '[0-9.]* s,' | grep -o '[0-9.]*'; }
unequal=$(virtual) equal=$(virtual --balance refine) again=$(virtual --balance refine)
python3 -c "import sys; sys.exit(0 if $equal < 0.85 * $unequal and $equal == $again else 1)"
check "balance of coupled gains nothing: $unequal s without, $equal and $again s with it" $?
overset_error() { "$bin/coupled" --cubes "$1" --pes 2 | grep -o 'overset [0-9.e+-]*' | grep -o '[0-9.e+-]*$'; }
coarse=$(overset_error 12) fine=$(overset_error 18)
python3 -c "import sys; sys.exit(0 if 1.9 < $coarse / $fine < 2.7 else 1)"
check "coupled is not second order: $coarse and $fine from the solution" $?

# overset: the same bits for every cut and machine, no orphans, second order, and the files.
overset=("$bin/overset" kuhn:16 ball:8)
answers '^background +4552 +145 +216 +0 ' "${overset[@]}" --pes 1 --chares 1
want=$(hash_of)
same "${overset[@]}" --pes 2 --chares 7
same "${mpirun[@]}" -n 2 "${overset[@]}" --chares 3
same "${overset[@]}" --sim pes=5,cost=100ns,seed=3 --chares 6
half=("$bin/overset" kuhn:16 ball:8 --symmetry z=0)
answers 'wall: [0-9]+ triangles, closed beyond z=0' "${half[@]}" --pes 1 --chares 1
want=$(hash_of)
same "${half[@]}" --pes 2 --chares 7
same "${mpirun[@]}" -n 2 "${half[@]}" --chares 3
answers '^overset2 ' "$bin/overset" kuhn:12 ball:4@.3:.5:0:.12 box:4@.7:.5:.1:.12 --symmetry z=0 --pes 2
answers 'orphan: background point [0-9]+ at .*: outside' "$bin/overset" kuhn:10 ball:6 --layers 2 --pes 1 \
  --plot "$scratch/overset" --json "$scratch/overset.json"
python3 - "$scratch" <<'END'
import json, sys
report = json.load(open(sys.argv[1] + "/overset.json"))
background, overset = report["results"][0]["meshes"]
assert background["orphans"] == len(background["orphan_list"]) > 0
assert sum(background[k] for k in ("field", "hole", "fringe", "orphans")) == 11**3
before, after = (open(f"{sys.argv[1]}/overset/{name}.svg").read() for name in ("before", "after"))
assert after.count("fill=\"#e00000\"") >= 1 and before.count("#e00000") == 0
END
check "the report of overset is not what was printed" $?
cat "$scratch/overset/background.exo" >/dev/null && "$bin/m2m_transfer" "$scratch/overset/background.exo" kuhn:2 >"$scratch/out" 2>&1
check "background.exo of overset cannot be read" $?
timeout 100 "$bin/overset" --study h --pes 2 >"$scratch/out" 2>&1 && tail -1 "$scratch/out" |
  python3 -c "import sys; order = float(sys.stdin.read().split()[-1]); sys.exit(0 if 1.8 < order < 2.2 else 1)"
check "overset is not second order" $?
answers '^ +16 .*[0-9]$' "$bin/overset" kuhn:8,16 box --study h --pes 2 --json "$scratch/overset.json"
[[ $(grep -c '^ ' "$scratch/out") -eq 3 && $(grep -c '"rms":' "$scratch/overset.json") -eq 2 ]]
check "overset does not refine what is given" $?
# The program compares winding numbers with solid angles.
answers "^ +101568 +[0-9.]+ +[0-9]+ +522754$" "$bin/overset" --study wall --pes 1

# m2m_transfer: what it writes as ExodusII and as VTU it reads again, with the same values.
transfer=("$bin/m2m_transfer" --fields linear --pes 1)
for format in exo vtu; do
  timeout 60 "${transfer[@]}" kuhn:3 kuhn:4 --out "$scratch/result.$format" >"$scratch/out" 2>&1 &&
    "${transfer[@]}" "$scratch/result.$format" kuhn:5 2>&1 | grep step >"$scratch/again.$format"
  check "result.$format cannot be read again" $?
done
[[ $(head -c 5 "$scratch/result.vtu") == @('<?xml'|'<VTKF') ]] && cmp -s "$scratch/again.exo" "$scratch/again.vtu"
check "result.vtu has another format, or other values" $?

# lb_lab: what a run saved is replayed: all files behind one --replay, as the shell names them for a *, or --replay repeated.
lab=("$bin/lb_lab" --strategy greedy)
timeout 60 "${lab[@]}" --workload linear --per-pe 4 --iterations 10 --period 5 --sim pes=4,cost=1us --save-snapshot "$scratch/snapshots" >"$scratch/out" 2>&1
check "lb_lab saves no snapshots" $?
files=("$scratch"/snapshots/linear-4-greedy/data.*.json.br)
answers '^ +0 +4 +16 greedy +1\.[0-9]+ +1\.0' "${lab[@]}" --replay "${files[@]}" --pes 1
answers '^ +0 +4 +16 greedy ' "${lab[@]}" --replay "${files[0]}" --replay "${files[1]}" --replay "${files[@]:2}" --pes 1
answers '^ +0 +4 +16 greedy ' "${lab[@]}" --replay "${files[@]}" --pes 1 --json "$scratch/replayed.json"
grep -q '"strategy": "greedy"' "$scratch/replayed.json"
check "lb_lab --replay --json writes no rows" $?
timeout 60 "${lab[@]}" --workload linear --per-pe 4 --iterations 10 --period 5 --sim pes=2,cost=1us --save-snapshot "$scratch/snapshots" --snapshot-format json >"$scratch/out" 2>&1
[[ $(echo "$scratch"/snapshots/linear-4-greedy/*) == "$scratch/snapshots/linear-4-greedy/data.0.json $scratch/snapshots/linear-4-greedy/data.1.json" ]]
check "files of a run on more PEs stay in the folder of snapshots" $?

answers 'hash' "${coupled[@]}" --reaction 0.5

finish
