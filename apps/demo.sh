#!/usr/bin/env bash
# The main job from a bare machine: installs what is missing, builds, and transfers a field between two real unstructured
# meshes: in one process, then under mpirun. Then error against run time over a series of source meshes.
set -euo pipefail
cd "$(dirname "$0")/.."

bash cmake/setup.sh
echo "demo: building"
mkdir -p build
cmake --preset release >build/demo.log 2>&1 || { cat build/demo.log; exit 1; }
cmake --build --preset release --target m2m_transfer -j "$(nproc)" >build/demo.log 2>&1 || { tail -40 build/demo.log; exit 1; }

transfer=build/release/bin/m2m_transfer
# Only here: as root, and with more ranks than cores, Open MPI wants to be told.
mpirun=(mpirun --oversubscribe)
if ((EUID == 0)); then mpirun+=(--allow-run-as-root); fi

meshes=build/demo
mkdir -p "$meshes"
# cube NAME H: an unstructured mesh of the unit cube with edges of about H, once.
cube() {
  [[ -e $meshes/$1.msh ]] || gmsh -v 0 -3 -format msh41 -clmax "$2" -clmin "$2" -o "$meshes/$1.msh" apps/m2m_transfer/cube.geo >/dev/null
}

data=${TESS_DATA:-../shared/data}
source=$data/nalu/3d_tet4_taylor_green_0p4.exo
target=$data/nalu/3d_tet4_taylor_green_0p2.exo
if [[ ! -e $source || ! -e $target ]]; then
  echo "demo: $data is not on this machine: meshes by gmsh instead"
  cube source 0.11
  cube target 0.08
  source=$meshes/source.msh
  target=$meshes/target.msh
fi

echo "== one process, all cores"
"$transfer" "$source" "$target" --field sin --out "$meshes/result.exo" --json "$meshes/result.json" --explain
for ranks in 1 2; do
  echo "== mpirun -n $ranks"
  "${mpirun[@]}" -n "$ranks" "$transfer" "$source" "$target" --field sin --pes 1
done

echo "== error against run time: unstructured cubes, the source refined, onto one target"
cube target 0.05
sources=()
for h in 0.16 0.11 0.08 0.056; do
  cube "source_$h" "$h"
  sources+=("$meshes/source_$h.msh")
done
"$transfer" "$(IFS=,; echo "${sources[*]}")" "$meshes/target.msh" --field sin --study "$meshes/study"
echo "written: $meshes/result.exo, $meshes/result.json"
