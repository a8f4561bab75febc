#!/usr/bin/env bash
# Builds an outside project on Tessera in one way, and runs its programs alone and (runtime) under mpirun.
#
#     outside.sh installed BUILD COMPONENTS…     with find_package, from an installation of this build folder
#     outside.sh source SOURCE COMPONENTS…       with add_subdirectory
#
# CXX is the compiler; MPIEXEC is empty where Tessera is built without MPI.
set -euo pipefail
way=$1
from=$(cd "$2" && pwd)
shift 2
components=("$@")
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Without optimisation: what is tested is the way, not the speed.
options=(-G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_UNITY_BUILD=ON "-DCOMPONENTS=$(IFS=';'; echo "${components[*]}")")
if [[ $way == installed ]]; then
  cmake --install "$from" --prefix "$scratch/prefix" >/dev/null
  # As another machine has it: the source folder of the project is not looked at.
  if grep -rl "$(dirname "$here")" "$scratch/prefix/lib/cmake" >"$scratch/leaks"; then
    echo "FAILED: the installation names the source folder: $(cat "$scratch/leaks")"
    exit 1
  fi
  options+=("-DCMAKE_PREFIX_PATH=$scratch/prefix")
else
  options+=("-DTESSERA=$from")
fi

cmake -S "$here/outside" -B "$scratch/build" "${options[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/build" >"$scratch/log" 2>&1 || { tail -40 "$scratch/log"; exit 1; }

failed=0
# prints PROGRAM WANT COMMAND…: the command prints this line, once.
prints() {
  local want=$1
  shift
  local found
  found=$("$@" 2>&1) || true
  if [[ $found == "$want" ]]; then
    echo "ok: ${*##*/}: $found"
  else
    echo "FAILED: ${*##*/} printed '$found', wanted '$want'"
    failed=1
  fi
}

declare -A answers=([runtime]="sum 90" [collide]="pairs 3" [field]="distance -0.49" [m2m]="inside 24, boundary 192")
for component in "${components[@]}"; do
  program=$scratch/build/uses_$component
  prints "${answers[$component]}" "$program"
  if [[ -n ${MPIEXEC:-} && ($component == runtime || $component == m2m) ]]; then
    prints "${answers[$component]}" "$MPIEXEC" --allow-run-as-root --oversubscribe -n 2 "$program" --pes 1
  fi
done

# The project installs its programs, and nothing of Tessera.
cmake --install "$scratch/build" --prefix "$scratch/there" >"$scratch/log" 2>&1 || { tail -5 "$scratch/log"; failed=1; }
if [[ $(find "$scratch/there" -type f -printf '%f\n' | sort) == $(printf 'uses_%s\n' "${components[@]}" | sort) ]]; then
  echo "ok: installs its programs"
else
  echo "FAILED: the project installs $(find "$scratch/there" -type f -printf '%P ')"
  failed=1
fi

if [[ " ${components[*]} " == *" runtime "* ]]; then
  prints "20 seeds pass" "$scratch/build/uses_testing"
  # The live view is there for the program that links it, and for no other one.
  for program in runtime:0 live_view:1; do
    prints "${program#*:}" bash -c "'$scratch/build/uses_${program%:*}' --help | grep -c -- ' --monitor '"
  done
fi

# Chares of the program, which migrate between the transfers of a coupling.
if [[ " ${components[*]} " == *" runtime "* && " ${components[*]} " == *" m2m "* ]]; then
  program=$scratch/build/uses_coupling
  prints "error below 1e-14: yes" "$program"
  prints "error below 1e-14: yes" "$program" --pes 3
  prints "error below 1e-14: yes" "$program" --sim pes=5,seed=3,migrate=0.2
  [[ -z ${MPIEXEC:-} ]] || prints "error below 1e-14: yes" "$MPIEXEC" --allow-run-as-root --oversubscribe -n 2 "$program" --pes 2
fi

# The project of README.md, with hello as its main.cpp.
if [[ $way == installed ]]; then
  cp -r "$here/small" "$scratch/small"
  cp "$here/../../apps/hello/main.cpp" "$scratch/small/main.cpp"
  cmake -S "$scratch/small" -B "$scratch/small/build" "${options[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
  cmake --build "$scratch/small/build" >"$scratch/log" 2>&1 || { tail -40 "$scratch/log"; exit 1; }
  prints "element 0: hello after 0 hops" bash -c "'$scratch/small/build/my_program' --pes 2 | head -1"
fi
exit $failed
