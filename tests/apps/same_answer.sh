#!/usr/bin/env bash
# same_answer.sh BIN MESHES: the answer of a transfer is the same bit for bit for every number of PEs, processes and chares,
# every voxel size, and every adversarial schedule. MESHES: the folder of make_meshes.sh.
source "$(dirname "$0")/../support/checks.sh"
bin=$1 meshes=$2

transfer=("$bin/m2m_transfer" "$meshes/cube_0.08.msh" "$meshes/cube_0.0566.msh" --field gaussian --field sin --policy nearest)

hash_of() { grep -o '"result_hash": "[0-9a-f]*"' "$1"; }

"${transfer[@]}" --pes 1 --chares 1 --json "$scratch/first.json" >/dev/null || exit 1
want=$(hash_of "$scratch/first.json")
[[ -n $want ]] || fail "no result_hash"
echo "one PE, one chare per mesh: $want"

# same COMMAND…: the command gives the same hash.
same() {
  rm -f "$scratch/again.json"
  timeout 60 "$@" --json "$scratch/again.json" >"$scratch/out" 2>&1
  local code=$?
  if [[ $code -eq 0 && $(hash_of "$scratch/again.json") == "$want" ]]; then
    pass
  else
    fail "(exit $code): $*"
    tail -5 "$scratch/out"
  fi
}

for pes in 1 2 4; do same "${transfer[@]}" --pes $pes; done
for chares in 2 7 64; do same "${transfer[@]}" --pes 2 --chares $chares; done
for voxel in 0.02 0.05 0.1 0.3; do same "${transfer[@]}" --pes 2 --voxel $voxel; done
same "${transfer[@]}" --pes 2 --partition hsfc
for ranks in 1 2 4; do same "${mpirun[@]}" -n $ranks "${transfer[@]}" --pes 1; done
same "${mpirun[@]}" -n 2 "${transfer[@]}" --pes 2
same "${transfer[@]}" --sim pes=16
for seed in 1 2 3; do same "${transfer[@]}" --sim pes=5,seed=$seed; done

# Most vertices of the target lie outside, many of them equally near to several vertices of the source.
source "$(dirname "$0")/box_mesh.sh"
box "$scratch/wide.msh" 3 -1 12
transfer=("$bin/m2m_transfer" kuhn:8 "$scratch/wide.msh" --field 'x+10*y+100*z' --policy nearest)
"${transfer[@]}" --pes 1 --chares 1 --json "$scratch/first.json" >/dev/null || exit 1
want=$(hash_of "$scratch/first.json")
[[ -n $want ]] || fail "no result_hash"
echo "mostly outside: $want"
for chares in 2 7 64 256; do same "${transfer[@]}" --pes 2 --chares $chares; done
same "${transfer[@]}" --pes 2 --voxel 0.03
same "${mpirun[@]}" -n 2 "${transfer[@]}" --pes 2
for seed in 4 5 6; do same "${transfer[@]}" --sim pes=5,seed=$seed; done

# A thousand transfers give the same answer, and take no more memory than ten.
same "${transfer[@]}" --pes 2 --repeat 3
memory_of() { grep -o '"peak_memory_bytes": [0-9]*' "$1" | grep -o '[0-9]*$'; }
small=("$bin/m2m_transfer" kuhn:8@0.2 kuhn:9@0.2 --field sin --policy nearest)
# no_growth COMMAND…: the peak of a thousand repeats exceeds that of ten by less than 4 MB.
no_growth() {
  "$@" --repeat 10 --json "$scratch/few.json" >"$scratch/out" 2>&1 &&
    timeout 120 "$@" --repeat 1000 --json "$scratch/many.json" >"$scratch/out" 2>&1
  local code=$? few=0 many=0
  ((code == 0)) && few=$(memory_of "$scratch/few.json") many=$(memory_of "$scratch/many.json")
  if ((code == 0 && few > 0 && many > 0 && many < few + 4000000)) && [[ $(hash_of "$scratch/few.json") == "$(hash_of "$scratch/many.json")" ]]; then
    pass
  else
    fail "(exit $code): $few bytes after 10 transfers, $many after 1000: $*"
    tail -5 "$scratch/out"
  fi
}
no_growth "${small[@]}" --pes 2
exits 0 "400 per mesh, 16 of them without tetrahedra" "$bin/m2m_transfer" kuhn:4 kuhn:3 --pes 1 --chares 400
no_growth "${mpirun[@]}" -n 2 "${small[@]}" --pes 1

finish
