#!/usr/bin/env bash
# The main job on a bare machine. Installs missing packages, builds, and transfers a field between two unstructured meshes
# of about 73 000 and 100 000 tetrahedra: in one process, then under mpirun. Then measures error against run time over a
# ladder of meshes. Writes pictures of both.
#     demo.sh [--quick] [--built BIN] [--into FOLDER]
# --quick: meshes of 4 000 to 37 000 tetrahedra. --built: uses the programs in the folder BIN; installs and builds nothing.
# --into: the folder for meshes and results (default: build/demo).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

source_h=0.04 target_h=0.0358
source_ladder=(0.16 0.113 0.08 0.0566 0.04) target_ladder=(0.143 0.101 0.0716 0.0506 0.0358)
built='' into=$root/build/demo
usage() {
  echo "usage: apps/demo.sh [--quick] [--built BIN] [--into FOLDER]" >&2
  exit 2
}
while (($# > 0)); do
  case $1 in
    --quick)
      source_h=0.08 target_h=0.0716
      source_ladder=(0.113 0.08 0.0566) target_ladder=(0.101 0.0716 0.0506)
      shift ;;
    --built | --into)
      [[ -n ${2:-} ]] || usage
      # Absolute: the working folder changes below.
      if [[ $1 == --built ]]; then built=$(cd "$2" && pwd); else into=$(realpath -m -- "$2"); fi
      shift 2 ;;
    *) usage ;;
  esac
done

if [[ -z $built ]]; then
  cd "$root"
  bash cmake/setup.sh
  echo "demo: building"
  mkdir -p build
  cmake --preset release >build/demo.log 2>&1 || { cat build/demo.log; exit 1; }
  cmake --build --preset release --target m2m_transfer -j "$(nproc)" >build/demo.log 2>&1 || { tail -40 build/demo.log; exit 1; }
  built=$root/build/release/bin
fi
transfer=$built/m2m_transfer
# Open MPI needs these options to run as root, and with more ranks than cores.
mpirun=(mpirun --oversubscribe)
if ((EUID == 0)); then mpirun+=(--allow-run-as-root); fi

mkdir -p "$into"
# cube H: prints the path of an unstructured mesh of the unit cube with edges of about H. The mesh is generated once.
cube() {
  local mesh=$into/cube_$1.msh
  if [[ ! -e $mesh ]]; then
    gmsh -v 0 -3 -format msh41 -clmax "$1" -clmin "$1" -o "$mesh.part.msh" "$root/apps/m2m_transfer/cube.geo" >/dev/null
    mv "$mesh.part.msh" "$mesh"
  fi
  echo "$mesh"
}

echo "demo: meshing"
source=$(cube $source_h)
target=$(cube $target_h)
echo "== one process, all cores"
"$transfer" "$source" "$target" --field sin --out "$into/result.exo" --json "$into/result.json" \
  --picture "$into/result.svg" --explain
for ranks in 1 2; do
  echo "== mpirun -n $ranks"
  "${mpirun[@]}" -n "$ranks" "$transfer" "$source" "$target" --field sin --pes 1 --json "$into/result_$ranks.json"
done

data=${TESS_DATA:-$root/../shared/data}
coarse=$data/nalu/3d_tet4_taylor_green_0p4.exo
fine=$data/nalu/3d_tet4_taylor_green_0p2.exo
if [[ -e $coarse && -e $fine ]]; then
  echo "== two meshes of a flow solver, ExodusII"
  "$transfer" "$coarse" "$fine" --field sin
fi

echo "== error against run time: unstructured cubes, each onto a slightly finer one"
sources=() targets=()
for h in "${source_ladder[@]}"; do sources+=("$(cube "$h")"); done
for h in "${target_ladder[@]}"; do targets+=("$(cube "$h")"); done
list() { (IFS=,; echo "$*"); }
"$transfer" "$(list "${sources[@]}")" "$(list "${targets[@]}")" --field sin --study "$into/study"
echo "demo: written: $into/result.svg (a picture: open it in a browser), result.exo (for ParaView), result.json,"
echo "demo:          $into/study/error_time.svg, error_edge.svg, study.csv, study.json"
