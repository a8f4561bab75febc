#!/usr/bin/env bash
# The main job from a bare machine: installs what is missing, builds, and transfers a field between two unstructured meshes
# of about a hundred thousand tetrahedra: in one process, then under mpirun. Then error against run time over a ladder of
# meshes. Leaves a picture of the result.
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
# cube H: an unstructured mesh of the unit cube with edges of about H, made once; its path.
cube() {
  local mesh=$meshes/cube_$1.msh
  if [[ ! -e $mesh ]]; then
    gmsh -v 0 -3 -format msh41 -clmax "$1" -clmin "$1" -o "$mesh.part.msh" apps/m2m_transfer/cube.geo >/dev/null
    mv "$mesh.part.msh" "$mesh"
  fi
  echo "$mesh"
}

echo "demo: meshing"
source=$(cube 0.04)    # about 73 000 tetrahedra
target=$(cube 0.0358)  # about 100 000
echo "== one process, all cores"
"$transfer" "$source" "$target" --field sin --out "$meshes/result.exo" --json "$meshes/result.json" \
  --picture "$meshes/result.svg" --explain
for ranks in 1 2; do
  echo "== mpirun -n $ranks"
  "${mpirun[@]}" -n "$ranks" "$transfer" "$source" "$target" --field sin --pes 1
done

data=${TESS_DATA:-../shared/data}
coarse=$data/nalu/3d_tet4_taylor_green_0p4.exo
fine=$data/nalu/3d_tet4_taylor_green_0p2.exo
if [[ -e $coarse && -e $fine ]]; then
  echo "== two meshes of a flow solver, ExodusII"
  "$transfer" "$coarse" "$fine" --field sin
fi

echo "== error against run time: unstructured cubes, each onto a somewhat finer one"
sources=() targets=()
for h in 0.16 0.113 0.08 0.0566 0.04; do sources+=("$(cube "$h")"); done
for h in 0.143 0.101 0.0716 0.0506 0.0358; do targets+=("$(cube "$h")"); done
list() { (IFS=,; echo "$*"); }
"$transfer" "$(list "${sources[@]}")" "$(list "${targets[@]}")" --field sin --study "$meshes/study"
echo "demo: written: $meshes/result.svg (a picture: open it in a browser), result.exo (for ParaView), result.json,"
echo "demo:          $meshes/study/error_time.svg, error_edge.svg, study.csv, study.json"
