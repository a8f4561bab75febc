#!/usr/bin/env bash
# with.sh shared_data|meshes|gnuplot|vtk|scipy LOCATION COMMAND…: runs the command if what it needs is there: the folder LOCATION,
# the program gnuplot, or VTK for Python. Otherwise exit code 77, which ctest reports as skipped.
set -uo pipefail
need=$1 location=$2
shift 2

case $need in
  shared_data) [[ -d ${TESS_DATA:-$location} ]] || missing="${TESS_DATA:-$location} does not exist; set TESS_DATA to the folder of real meshes" ;;
  meshes) [[ -e $location/hexes.msh ]] || missing="$location has no meshes; gmsh generates them (cmake/setup.sh installs it)" ;;
  gnuplot) command -v gnuplot >/dev/null || missing="gnuplot is not installed (cmake/setup.sh installs it)" ;;
  vtk) /usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null || missing="VTK for Python is not installed (Debian: python3-vtk9)" ;;
  scipy) "${1:-}" -c 'import scipy' 2>/dev/null || missing="NumPy and SciPy are not installed (pip install scipy; Debian's python3-scipy needs Boost 1.74)" ;;
  *) echo "with.sh: unknown need '$need'"; exit 2 ;;
esac
if [[ -n ${missing:-} ]]; then
  echo "skipped: $missing"
  exit 77
fi
exec "$@"
