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
built='' into=$root/build/demo waited=0
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
  echo "demo: packages, one program and four transfers: about four minutes on two cores"
  bash cmake/setup.sh --only build
  # Meshes and plots are wanted later: their packages come while the compiler runs.
  mkdir -p build
  bash cmake/setup.sh --only meshes >build/setup.log 2>&1 &
  meshes_installed=$!
  cmake --preset release -DTESS_TESTS=OFF >build/demo.log 2>&1 || { cat build/demo.log; exit 1; }
  cmake --build --preset release --target m2m_transfer -j "$(nproc)" >build/demo.log 2>&1 &
  compiled=$!
  while sleep 1 && kill -0 $compiled 2>/dev/null; do
    ((++waited % 20 == 0)) && echo "demo: compiled $(tail -n 1 build/demo.log | sed -nE 's/^\[([0-9]+)\/([0-9]+)\].*/\1 of \2/p') after $SECONDS s"
  done
  wait $compiled || { tail -40 build/demo.log; exit 1; }
  wait $meshes_installed || { cat build/setup.log; exit 2; }
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

source=$(cube $source_h)
target=$(cube $target_h)
# run NAME COMMAND…: its table goes into a file of this name.
run() {
  local table=$into/$1.txt
  shift
  "$@" >"$table" 2>&1 || { cat "$table"; exit 1; }
}
# row WORD FILE: the rows of a table that begin with it.
row() { grep -E "^ *$1 " "$into/$2.txt"; }
echo "demo: the field sin from one mesh of the unit cube to another one ($SECONDS s so far)"
run result "$transfer" "$source" "$target" --field sin --out "$into/result.exo" --json "$into/result.json" --picture "$into/result.svg" --explain
for ranks in 1 2; do
  run result_$ranks "${mpirun[@]}" -n $ranks "$transfer" "$source" "$target" --field sin --pes 1 --json "$into/result_$ranks.json"
done
row 'vertices' result
grep -E -A 1 '^ *error' "$into/result.txt"
grep -E -A 1 '^ *seconds' "$into/result.txt"
hashes=$(for name in result result_1 result_2; do row result $name | awk '{ print $2 }'; done | sort -u)
if (($(wc -w <<<"$hashes") != 1)); then
  echo "demo: error: the results differ on threads, one rank and two ranks:" $hashes >&2
  exit 1
fi
echo "the same on threads, one rank and two ranks: hash $hashes"

sources=() targets=()
for h in "${source_ladder[@]}"; do sources+=("$(cube "$h")"); done
for h in "${target_ladder[@]}"; do targets+=("$(cube "$h")"); done
list() { (IFS=,; echo "$*"); }
run study "$transfer" "$(list "${sources[@]}")" "$(list "${targets[@]}")" --field sin --study "$into/study"
echo "error against run time, ${#sources[@]} meshes: L2 error ~ edge^$(tail -n 2 "$into/study.txt" | awk '$1 == "sin" { print $2 }'), error ~ seconds^$(tail -n 2 "$into/study.txt" | awk '$1 == "sin" { print $4 }')"
echo "demo: done after $SECONDS s. In $into: result.svg, study/error_time.svg (pictures), result.exo (ParaView),"
echo "demo: result.txt (what was used and left out), result.json, study.txt, study/study.json"
