#!/usr/bin/env bash
# make_meshes.sh FOLDER: generates the meshes that tests read from FOLDER, with gmsh. Exit code 77 (skipped) without gmsh.
set -euo pipefail
folder=$1
here=$(cd "$(dirname "$0")" && pwd)

if ! command -v gmsh >/dev/null; then
  echo "skipped: gmsh is not installed (cmake/setup.sh installs it)"
  exit 77
fi
mkdir -p "$folder"
# mesh NAME GEOMETRY OPTIONS…: the file appears complete or not at all.
mesh() {
  local name=$1 geometry=$2
  shift 2
  gmsh -v 1 -3 -format msh41 "$@" -o "$folder/$name.part.msh" "$geometry"
  mv "$folder/$name.part.msh" "$folder/$name.msh"
}

for h in 0.16 0.113 0.08 0.0566; do
  mesh "cube_$h" "$here/../../apps/m2m_transfer/cube.geo" -clmin "$h" -clmax "$h"
done
mesh shaft_coarse "$here/meshes/shaft.geo" -setnumber h 0.25
mesh shaft_binary "$here/meshes/shaft.geo" -setnumber h 0.25 -bin
mesh shaft_22 "$here/meshes/shaft.geo" -setnumber h 0.25 -format msh22
mesh shaft_22_binary "$here/meshes/shaft.geo" -setnumber h 0.25 -format msh22 -bin
mesh shaft_quadratic "$here/meshes/shaft.geo" -setnumber h 0.4 -order 2
for part in 1 2; do
  mesh "half_sphere_$part" "$here/../../apps/overset/half_sphere.geo" -setnumber part "$part"
done
mesh hexes "$here/meshes/hexes.geo"
gmsh -v 1 -setstring file "$(realpath "$folder")/view.part.msh" - "$here/meshes/view.geo"
mv "$folder/view.part.msh" "$folder/view.msh"
