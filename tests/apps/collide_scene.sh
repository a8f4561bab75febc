#!/usr/bin/env bash
# collide_scene.sh BIN: the program from outside. One answer serially, for any PEs, processes and voxel sizes; a result file
# with every key; bad input in one line with exit code 2 before anything runs.
source "$(dirname "$0")/../support/checks.sh"
bin=$1
scene=$bin/collide_scene

check() {  # check WHAT CODE: counts.
  if [[ $2 == 0 ]]; then pass; else fail "$1"; fi
}
value_of() { grep -o "\"$1\": [^,]*" "$scratch/now.json" | head -1 | sed 's/.*: //; s/"//g'; }

# What a user has: two files, as OBJ and PLY.
printf 'v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n' >"$scratch/floor.obj"
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n1 1 -1\n3 1 -1\n3 1.5 1\n1 1.5 1\n3 0 1 2\n3 0 2 3\n' >"$scratch/wall.ply"
"$scene" "$scratch/floor.obj" "$scratch/wall.ply" --triangles --json "$scratch/now.json" --out "$scratch/out/hits" >"$scratch/table"
check "two files" $?
for key in objects pairs candidates false_positive_rate voxel_size levels voxels left_out seconds_per_step ns_per_object \
  peak_memory_bytes result_hash; do
  grep -q "\"$key\": [^n]" "$scratch/now.json"
  check "the result has a value for the key $key" $?
done
[[ $(value_of objects) == 4 && $(value_of pairs) -ge 2 && $(value_of pairs) -le $(value_of candidates) ]]
check "the wall stands through the floor" $?
for file in hits.svg hits_owners.svg hits_hits.vtp hits_pairs.vtp; do
  [[ -s $scratch/out/$file ]]
  check "--out writes $file" $?
done
"$scene" "$scratch/floor.obj" --json "$scratch/now.json" >"$scratch/table" && grep -q -- '--self' "$scratch/table"
check "one model without --self: says so" $?
[[ $(value_of pairs) == 0 ]]
check "one model has no pairs" $?
"$scene" "$scratch/floor.obj" --self --json "$scratch/now.json" >"$scratch/table"
[[ $(value_of pairs) == 1 ]]
check "--self finds the two halves of a square" $?
"$scene" "$scratch/floor.obj" --self --triangles --open --json "$scratch/now.json" >"$scratch/table"
[[ $(value_of pairs) == 0 ]]
check "--open: they only touch" $?

# One answer.
same() {  # same COMMAND…: gives the hash of the first run.
  rm -f "$scratch/now.json"
  timeout 100 "$@" --json "$scratch/now.json" >"$scratch/out.txt" 2>&1
  local code=$?
  if [[ $code == 0 && $(value_of result_hash) == "$want" ]]; then pass; else fail "(exit $code) $*"; fi
}
for arguments in "planes:8192 --triangles --move drift:0.3 --steps 3" "boxes:2000 --move drift --steps 2" \
  "crowd:4096 --triangles --self --steps 2" "disparity:2000" "lshapes:40 --triangles" "long_needles:3000 --triangles"; do
  read -ra what <<<"$arguments"
  "$scene" "${what[@]}" --json "$scratch/now.json" >"$scratch/out.txt" || fail "$arguments"
  want=$(value_of result_hash)
  [[ $(value_of candidates) -gt 0 ]]
  check "$arguments has candidates" $?
  same "$scene" "${what[@]}" --serial --repeat 2
  for pes in 1 2 4; do same "$scene" "${what[@]}" --pes $pes; done
  same "$scene" "${what[@]}" --sim pes=7,seed=3,migrate=0.1
  same "$scene" "${what[@]}" --sim pes=4,seed=5 --voxel-size 1.5
  same "$scene" "${what[@]}" --voxel-size 0.7
  same "${mpirun[@]}" -n 2 "$scene" "${what[@]}" --pes 1
  same "${mpirun[@]}" -n 2 "$scene" "${what[@]}" --pes 2
done
# Kept pairs: the same answer, and one search for steps that move little.
for arguments in "planes:8192 --triangles --move drift:0.01 --steps 5" "crowd:4096 --self --move turn:0.01 --steps 5"; do
  read -ra what <<<"$arguments"
  "$scene" "${what[@]}" --json "$scratch/now.json" >"$scratch/out.txt" || fail "$arguments"
  want=$(value_of result_hash)
  for machine in "--pes 1" "--pes 3" "--sim pes=5,seed=3,migrate=0"; do
    read -ra on <<<"$machine"
    for slack in 0.02 1e-9; do same "$scene" "${what[@]}" "${on[@]}" --slack $slack; done
    [[ $(value_of searches) == 5 ]]
    check "$arguments $machine: each step searches with a tiny slack" $?
    same "$scene" "${what[@]}" "${on[@]}" --slack 0.1
    [[ $(value_of searches) == 1 ]]
    check "$arguments $machine: one step searches with a slack of a tenth" $?
  done
  same "${mpirun[@]}" -n 2 "$scene" "${what[@]}" --slack 0.1
done
# The files of --out are the same, too.
"$scene" planes:2048 --triangles --out "$scratch/serial" >"$scratch/out.txt"
"$scene" planes:2048 --triangles --out "$scratch/chares" --pes 3 >"$scratch/out.txt"
for file in .svg _hits.vtp _pairs.vtp; do
  cmp -s "$scratch/serial$file" "$scratch/chares$file"
  check "$file from chares is that of one thread" $?
done

# Reports.
"$scene" planes:4096 --study voxels --out "$scratch/out/planes" >"$scratch/table" && grep -q 'triangles .* 0.00 ' "$scratch/table"
check "--study voxels" $?
"$scene" needles:2000 --study voxels >"$scratch/table" && ! grep -q 'OTHER PAIRS' "$scratch/table"
check "the study of thin triangles, whose candidates are pieces in one row" $?
for file in planes_study.csv planes_study_time.csv planes_study_error.csv; do
  [[ -s $scratch/out/$file ]]
  check "the study writes $file" $?
done
[[ $(wc -l <"$scratch/out/planes_study.csv") == 17 ]]
check "the study has 16 rows" $?
"$scene" crowd:8192 --study pes --machines 1,20 --steps 11 --balance none,greedy_refine --out "$scratch/out/crowd" >"$scratch/table" &&
  [[ $(wc -l <"$scratch/table") == 5 ]]
check "--study pes" $?
for name in none greedy_refine; do
  grep -q "^$name,20," "$scratch/out/crowd_pes.csv"
  check "the study names the curve of $name" $?
done
"$scene" --stability >"$scratch/out.txt" 2>&1 && grep -q '^[1-9][0-9]* cases, 0 failed' "$scratch/out.txt"
check "--stability" $?
explains() {  # explains LINE ARGUMENT…
  local line=$1
  shift
  "$scene" "$@" --explain >"$scratch/out.txt" 2>&1 && grep -q -- "$line" "$scratch/out.txt"
  check "$* explains '$line'" $?
}
explains 'exact tests *left out of the run' planes:64
explains 'exact tests *used' planes:64 --triangles
explains 'exact tests *left out: the objects are boxes' boxes:64
explains 'runtime *left out' boxes:64
explains 'runtime *used' boxes:64 --pes 2
explains 'models *left out' boxes:64
explains 'one model has no pairs' wave:64
explains 'slack *left out' boxes:64
explains 'slack *0.25 .*kept' boxes:64 --pes 1 --slack 0.25
explains 'voxel size *2.5 ' wave:64 --voxel-size 2.5
"$scene" "$scratch/floor.obj" "$scratch/wall.ply" --pes 2 --voxel-size 0.01 >"$scratch/out.txt" 2>&1 && grep -q 'error *25' "$scratch/out.txt"
check "the error is measured, whatever the voxels of the run" $?

"$scene" long_needles:2000 --triangles --pes 2 --json "$scratch/now.json" >"$scratch/out.txt" 2>&1
[[ $(value_of pieces) -gt $(value_of objects) ]] && grep -q "$(value_of pieces) pieces of long thin triangles" "$scratch/out.txt"
check "long thin triangles are searched in pieces" $?
"$scene" needles:2000 --triangles --pes 2 --voxel-size 0.1 --json "$scratch/now.json" >"$scratch/out.txt" 2>&1
[[ $(value_of pieces) == $(value_of objects) ]] && grep -q 'long thin triangles, whole' "$scratch/out.txt"
check "with a voxel size they are whole: as many pieces as objects" $?

# refuses WORD COMMAND…: exit code 2, one line with WORD on standard error, nothing on standard output, no file.
refuses() {
  local word=$1
  shift
  rm -f "$scratch/no.json"
  "$@" --json "$scratch/no.json" >"$scratch/out.txt" 2>"$scratch/err" </dev/null
  local code=$?
  if [[ $code == 2 && $(wc -l <"$scratch/err") == 1 && ! -s $scratch/out.txt && ! -e $scratch/no.json ]] &&
    grep -q -- "$word" "$scratch/err"; then
    pass
  else
    fail "$* (exit $code): $(cat "$scratch/err")"
  fi
}
: >"$scratch/empty.obj"
printf 'hello\n' >"$scratch/text.ply"
printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' >"$scratch/nan.obj"
head -c -6 "$scratch/wall.ply" >"$scratch/cut.ply"
printf 'hello\n' >"$scratch/text.stl"
refuses INPUT "$scene"
refuses 'missing.obj: cannot be opened' "$scene" "$scratch/missing.obj"
refuses 'empty.obj: holds no faces' "$scene" "$scratch/floor.obj" "$scratch/empty.obj"
refuses 'nan.obj: vertex 2 of triangle 0' "$scene" "$scratch/nan.obj" --pes 2
refuses 'text.ply: is not a PLY file' "$scene" "$scratch/text.ply"
refuses 'cut.ply: .*truncated' "$scene" "$scratch/cut.ply"
refuses 'text.stl: is not an STL file' "$scene" "$scratch/text.stl"
mkdir "$scratch/folder.obj"
refuses 'folder.obj: is a directory' "$scene" "$scratch/folder.obj"
refuses 'boxs:3: is neither a file' "$scene" boxs:3
refuses "boxes:0" "$scene" boxes:0
refuses 'boxes:9: its objects are boxes' "$scene" "$scratch/floor.obj" boxes:9
refuses '--triangles: boxes:9 has boxes' "$scene" boxes:9 --triangles
refuses '--move own: the scene does not move' "$scene" boxes:9 --move own
refuses '--move sideways' "$scene" planes:64 --move sideways
refuses '--voxel-size' "$scene" planes:64 --voxel-size 0
refuses 'voxel size 1e-09' "$scene" planes:64 --voxel-size 1e-9
refuses '--steps' "$scene" planes:64 --steps 0
refuses '--serial' "$scene" planes:64 --serial --pes 2
refuses '--slack: is for chares' "$scene" planes:64 --slack 1
refuses '--slack' "$scene" planes:64 --pes 2 --slack -1
refuses '--repeat 2 does not work with --slack 1' "$scene" planes:64 --pes 2 --slack 1 --repeat 2
refuses '--nonsense' "$scene" planes:64 --nonsense
refuses '--out' "$scene" planes:64 --out "$scratch/empty.obj/x"
refuses 'missing.obj' "${mpirun[@]}" -n 2 "$scene" "$scratch/missing.obj" --pes 1
refuses '--serial' "${mpirun[@]}" -n 2 "$scene" planes:64 --serial

finish
