#!/usr/bin/env bash
# The particle program from outside: one answer for any PEs, processes and blocks; a result file with every key; bad
# scenes and options in one line with exit code 2.
set -uo pipefail
bin=$1
scenes=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
passed=0
mpirun=(mpirun --allow-run-as-root --oversubscribe)
particles=$bin/particles

check() {  # check WHAT TRUE: counts.
  if [[ $2 == 0 ]]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $1"
  fi
}

cat >"$scratch/scene.json" <<'SCENE'
{"dt": 0.01, "steps": 60,
 "objects": [{"shape": {"file": "wedge.obj"}, "resolution": 24, "thickness": 0.4, "motion": {"spin": [0, 1, 0]}}],
 "emitters": [{"count": 500, "box": {"low": [-1, -1, 1], "high": [1, 1, 2]}, "velocity": [0, 0, -3], "spread": 0.5}],
 "rules": {"gravity": [0, 0, -9.81], "impact": {"restitution": 0.6}},
 "outputs": {"statistics": 20, "trajectories": 20, "slice": {}}}
SCENE
printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 1\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n' >"$scratch/wedge.obj"

hash_of() { grep -o '"result_hash": "[0-9a-f]*"' "$1"; }
"$particles" "$scratch/scene.json" --pes 1 --json "$scratch/first.json" --out "$scratch/out" >"$scratch/table" || exit 1
want=$(hash_of "$scratch/first.json")
echo "one PE: $want"

for key in scene particles steps pes ns_per_particle_step field method cells build_seconds bytes bytes_compressed \
  nonfinite tunnelled energy_start energy_end measures result_hash; do
  grep -q "\"$key\":" "$scratch/first.json"
  check "the result has the key $key" $?
done
for file in field.svg paths.svg trajectories.pvd trajectories/step_000000060.vtp; do
  [[ -s $scratch/out/$file ]]
  check "--out writes $file" $?
done
[[ $(grep -c DataSet "$scratch/out/trajectories.pvd") == 4 ]]
check "the series has a snapshot for each time" $?

# same COMMAND…: gives the same hash.
same() {
  rm -f "$scratch/again.json"
  timeout 60 "$@" --json "$scratch/again.json" >"$scratch/out.txt" 2>&1
  [[ $? == 0 && $(hash_of "$scratch/again.json") == "$want" ]]
  check "$*" $?
}
for pes in 2 4; do same "$particles" "$scratch/scene.json" --pes $pes; done
for ranks in 1 2 4; do same "${mpirun[@]}" -n $ranks "$particles" "$scratch/scene.json" --pes 1; done
same "${mpirun[@]}" -n 2 "$particles" "$scratch/scene.json" --pes 2
for block in 0.15 0.6 50; do
  sed "s/\"steps\": 60/\"steps\": 60, \"block\": $block, \"exchange\": 3/" "$scratch/scene.json" >"$scratch/cut.json"
  same "$particles" "$scratch/cut.json" --pes 2
done
for seed in 1 2; do same "$particles" "$scratch/scene.json" --sim "pes=4,seed=$seed,migrate=0.1"; done

# A balancer moves blocks (cut small: there are many), and changes nothing.
sed 's/"steps": 60/"steps": 60, "block": 0.3, "exchange": 3/' "$scratch/scene.json" >"$scratch/cut.json"
balanced() {  # balanced STRATEGY COMMAND…
  local strategy=$1
  shift
  same "$@" "$scratch/cut.json" --balance "$strategy"
  [[ $(grep -A1 '"rounds":' "$scratch/again.json" | tr -d ' \n') =~ \"rounds\":[1-9][0-9]*,\"moves\":[1-9] ]]
  check "the balancer of $* moves blocks" $?
}
balanced rotate "$particles" --pes 2
balanced greedy "$particles" --pes 4
balanced rotate "${mpirun[@]}" -n 2 "$particles" --pes 1
balanced rotate,when=periodic,period=1ms "${mpirun[@]}" -n 2 "$particles" --pes 2
balanced random "$particles" --sim pes=8,seed=3,migrate=0.1
grep -q '"rounds":' "$scratch/first.json"
check "no balancer, no rounds" $((! $?))

# Compressed fields: another answer, the same for all PEs and processes.
"$particles" "$scratch/scene.json" --pes 1 --compressed --json "$scratch/compressed.json" --out "$scratch/out" >"$scratch/table" || exit 1
flat=$want
want=$(hash_of "$scratch/compressed.json")
[[ $want != "$flat" && -s $scratch/out/field.svg ]] && grep -q compressed "$scratch/table"
check "--compressed is another run" $?
bytes_of() { grep -o "\"$1\": [0-9]*" "$scratch/compressed.json" | head -1 | grep -o '[0-9]*$'; }
(($(bytes_of bytes) == 24 * 24 * 24 * 8 && $(bytes_of bytes_compressed) > 0 && $(bytes_of bytes_compressed) < $(bytes_of bytes)))
check "bytes of a compressed run" $?
same "$particles" "$scratch/scene.json" --compressed --pes 4
same "${mpirun[@]}" -n 2 "$particles" "$scratch/scene.json" --compressed --pes 1 --balance rotate
sed 's/"steps": 60/"steps": 60, "compression": {}/' "$scratch/scene.json" >"$scratch/cut.json"
same "$particles" "$scratch/cut.json" --pes 2
want=$flat

# The blurred constructions, too, are the work of all PEs; a field from a file gives what the built one gave.
for method in normals potential; do
  sed "s/\"resolution\": 24/\"resolution\": 64, \"method\": \"$method\", \"blur\": {\"radius\": 2, \"rounds\": 3}/" \
    "$scratch/scene.json" >"$scratch/blurred.json"
  "$particles" "$scratch/blurred.json" --pes 1 --json "$scratch/first.json" >"$scratch/out.txt" || failed=$((failed + 1))
  want=$(hash_of "$scratch/first.json")
  for pes in 2 5; do same "$particles" "$scratch/blurred.json" --pes $pes; done
  same "${mpirun[@]}" -n 2 "$particles" "$scratch/blurred.json" --pes 2
  same "$particles" "$scratch/blurred.json" --sim pes=4,per-process=2,seed=3
  sed 's/"slice": {}/"fields": true/' "$scratch/blurred.json" >"$scratch/saving.json"
  same "$particles" "$scratch/saving.json" --pes 2 --out "$scratch/saved"
  sed 's/"resolution": 64, .*"motion"/"field": "saved\/field_0.dnf", "motion"/' "$scratch/blurred.json" >"$scratch/loading.json"
  grep -q '"field": "saved/field_0.dnf", "motion"' "$scratch/loading.json"
  check "the scene loads a field" $?
  same "$particles" "$scratch/loading.json" --pes 2
  same "${mpirun[@]}" -n 2 "$particles" "$scratch/loading.json" --pes 1
done
"$particles" "$scratch/loading.json" --steps 0 --explain >"$scratch/out.txt" && grep -q 'fields: 0 built, 1 read from files' "$scratch/out.txt"
check "--explain says that a field is read" $?
want=$flat

# refuses WORD COMMAND…: exit code 2, one line with WORD, nothing written.
refuses() {
  local word=$1
  shift
  rm -f "$scratch/none.json"
  "$@" --json "$scratch/none.json" >"$scratch/out.txt" 2>"$scratch/err" </dev/null
  [[ $? == 2 && $(wc -l <"$scratch/err") == 1 && ! -e $scratch/none.json ]] && grep -q -- "$word" "$scratch/err"
  local told=$?  # "$(…)" below has an exit code of its own
  check "$* ($(cat "$scratch/err"))" $told
}
edited() {  # edited SED-COMMAND: a scene with a mistake.
  sed "$1" "$scratch/scene.json" >"$scratch/bad.json"
  echo "$scratch/bad.json"
}
refuses 'resolution: 0 is not within 4 … 1024' "$particles" "$(edited 's/"resolution": 24/"resolution": 0/')"
refuses 'unknown key' "$particles" "$(edited 's/"resolution"/"resolutoin"/')"
refuses 'compression.cells: 0.6 is not within 0 … 0.5' "$particles" "$(edited 's/"steps": 60/"steps": 60, "compression": {"cells": 0.6}/')"
refuses 'trilinear' "$particles" --compressed "$(edited 's/"rules": {/"rules": {"look_up": "trilinear", /')"
refuses 'none.obj: cannot be opened' "$particles" "$(edited 's/wedge.obj/none.obj/')"
cp "$scratch/saved/field_0.dnf" "$scratch/damaged.dnf"
printf 'x' | dd of="$scratch/damaged.dnf" bs=1 seek=3000 conv=notrunc status=none
sed 's/saved.field_0.dnf/damaged.dnf/' "$scratch/loading.json" >"$scratch/bad.json"
refuses 'objects\[0\].field: .*damaged.dnf: damaged: its checksum' "$particles" "$scratch/bad.json"
sed 's/wedge.obj/other.obj/' "$scratch/loading.json" >"$scratch/bad.json"
sed 's/v 0 0 1/v 0 0 0.7/' "$scratch/wedge.obj" >"$scratch/other.obj"
refuses 'is the field of another shape' "$particles" "$scratch/bad.json"
refuses 'outputs.fields: true, and the fields are compressed' "$particles" "$scratch/saving.json" --compressed --out "$scratch/saved"
refuses 'is not JSON' "$particles" "$(edited 's/"dt": 0.01,/"dt": 0.01/')"
printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' >"$scratch/nan.obj"
printf 'v 0 0 0\n' >"$scratch/empty.obj"
refuses 'vertex 2 of triangle 0' "$particles" "$(edited 's/wedge.obj/nan.obj/')"
refuses 'holds no faces' "$particles" "$(edited 's/wedge.obj/empty.obj/')"
refuses 'shear' "$particles" \
  "$(edited 's/"motion"/"transform": {"matrix": [[1, 1, 0], [0, 1, 0], [0, 0, 1]]}, "motion"/')"
refuses 'near-zero thickness' "$particles" "$(edited 's/{"file": "wedge.obj"}/{"plate": {"half": 1}}/; s/"motion"/"method": "normals", "motion"/; s/"impact": {"restitution": 0.6}/"surface_drag": {"rate": 1, "threshold": 0.1}/')"
refuses 'open sheet.*take sides two' "$particles" "$(edited 's/{"file": "wedge.obj"}/{"plate": {"half": 1}}/')"
refuses 'missing.json' "$particles" "$scratch/missing.json"
refuses SCENE "$particles"
refuses greedy_refine "$particles" "$scratch/scene.json" --balance nonsense
refuses sometimes "$particles" "$scratch/scene.json" --balance rotate,when=sometimes
refuses --steps "$particles" "$scratch/scene.json" --steps=-1
refuses 'motion.scale: -1 a second takes the scale' "$particles" --steps 150 "$(edited 's/"motion": {/"motion": {"scale": -1, /')"
refuses --resolutions "$particles" "$scratch/scene.json" --study --resolutions 16,2
refuses --out "$particles" "$scratch/scene.json" --out "$scratch/wedge.obj"
refuses 'unknown key' "${mpirun[@]}" --quiet -n 2 "$particles" "$(edited 's/"resolution"/"resolutoin"/')" --pes 1

# What cannot be written is refused before anything runs.
unwritable() {  # unwritable WORD COMMAND…: exit code 2, one line with WORD, and not a line of the table.
  local word=$1
  shift
  "$@" >"$scratch/out.txt" 2>"$scratch/err" </dev/null
  [[ $? == 2 && $(wc -l <"$scratch/err") == 1 && ! -s $scratch/out.txt ]] && grep -q -- "$word" "$scratch/err"
  local told=$?  # "$(…)" below has an exit code of its own
  check "$* ($(cat "$scratch/err"))" $told
}
unwritable '--json /nonexistent/x.json: cannot be written: its folder /nonexistent does not exist; give' \
  "$particles" "$scratch/scene.json" --json /nonexistent/x.json
unwritable "--json $scratch: cannot be written: is a directory; give" "$particles" "$scratch/scene.json" --json "$scratch"
unwritable 'wedge.obj is not a directory' "$particles" "$scratch/scene.json" --json "$scratch/wedge.obj/x.json"
for file in field.svg paths.svg trajectories.pvd; do
  mkdir -p "$scratch/taken/$file"
  unwritable "--out $scratch/taken $scratch/taken/$file: cannot be written: is a directory; give" \
    "$particles" "$scratch/scene.json" --out "$scratch/taken"
  rm -r "$scratch/taken"
done
: >"$scratch/taken"
unwritable '--out: .*taken cannot be made a folder' "$particles" "$scratch/scene.json" --out "$scratch/taken"
mkdir -p "$scratch/late/trajectories/step_000000020.vtp"
unwritable '--out .*late/trajectories/step_000000020.vtp: cannot be written: is a directory; give' \
  "$particles" "$scratch/scene.json" --pes 1 --out "$scratch/late"
unwritable '--json' "${mpirun[@]}" --quiet -n 2 "$particles" "$scratch/scene.json" --pes 1 --json /nonexistent/x.json
unwritable '--resolutions: needs --study; give one, or leave it out' "$particles" "$scratch/scene.json" --resolutions 16,32
"$particles" "$scratch/scene.json" --pes 1 --steps 0 --json "$scratch/new/r.json" --out "$scratch/new" >"$scratch/out.txt" 2>&1 &&
  [[ -s $scratch/new/r.json ]]
check "--json into the folder that --out makes" $?
"$particles" "$scratch/scene.json" --study --resolutions 16 --json "$scratch/study.json" --out "$scratch/study" >"$scratch/out.txt" 2>&1 &&
  [[ $(grep -c '"of_tree":' "$scratch/study.json") == "$(grep -cE '^(field|rule|cost) ' "$scratch/out.txt")" && -s $scratch/study/study_step.csv ]]
check "the study has a result per line of its table, and pictures" $?
unwritable '--steps 5 does not work with --study' "$particles" "$scratch/scene.json" --study --steps 5

# Names are bytes: one that is not UTF-8 is written with what it has of that, one with a newline is shown in one line.
odd=$scratch/b$'\xff'd.json
cp "$scratch/scene.json" "$odd"
same "$particles" "$odd" --pes 1
unwritable 'none\\n.json: cannot be read' "$particles" "$scratch/none"$'\n'".json"

# Memory: what cannot fit is refused, what does not fit after all ends in one line.
limited() { (ulimit -v 1000000 && "$@"); }
crowded() { edited "s/\"count\": 500/\"count\": $1/"; }
refuses '1000000000 particles make the run .* GB large' limited "$particles" "$(crowded 1000000000)" --pes 1 --steps 0
refuses '20000000 particles make the run' limited "$particles" "$(crowded 20000000)" --pes 1 --steps 0
refuses 'memory is exhausted' limited "$particles" "$(crowded 14000000)" --pes 1 --steps 0
refuses 'memory is exhausted' limited "$particles" "$(crowded 14000000)" --pes 2 --steps 0

# --explain lists what is built and what uses it.
falls='s/, "impact": {"restitution": 0.6}//'
explains() {  # explains LINE COMMAND…
  local line=$1
  shift
  "$@" --steps 0 --explain >"$scratch/out.txt" 2>&1 && grep -q -- "$line" "$scratch/out.txt"
  check "$* explains '$line'" $?
}
explains 'normals: used, by rules, the picture' "$particles" "$scratch/scene.json" --out "$scratch/out"
explains 'normals: used, by rules$' "$particles" "$scratch/scene.json"
explains 'distances: used, by the picture' "$particles" "$(edited "$falls")" --out "$scratch/out"
explains 'normals: used, by the picture' "$particles" "$(edited "$falls")" --out "$scratch/out"
explains 'fields: 1 built, 0 read from files' "$particles" "$(edited "$falls")" --out "$scratch/out"
explains 'fields: left out, no rule asks' "$particles" "$(edited "$falls")"
explains 'distances: left out' "$particles" "$(edited "$falls")"

"$particles" "$scratch/scene.json" --steps 0 --balance rotate --explain >"$scratch/out.txt" &&
  grep -q 'balancer: used, rotate, at_sync' "$scratch/out.txt"
check "--explain names the balancer" $?
"$particles" --stability >"$scratch/out.txt" 2>&1 && grep -q ' 0 failed' "$scratch/out.txt"
check "--stability" $?
"$particles" --help-scene >"$scratch/out.txt" && grep -q surface_flow "$scratch/out.txt"
check "--help-scene" $?
for scene in "$scenes"/*.json; do
  timeout 60 "$particles" "$scene" --steps 0 --pes 2 --explain >"$scratch/out.txt" 2>&1 && grep -q 'impact: used' "$scratch/out.txt"
  explained=$?
  check "$scene ($(tail -1 "$scratch/out.txt"))" $explained
done

echo "$passed passed, $failed failed"
((failed == 0))
