#!/usr/bin/env bash
# Builds an outside project on Tessera in one way, and runs its programs alone and (runtime) under mpirun.
#
#     outside.sh installed BUILD COMPONENTS…     with find_package and pkg-config, from an installation of this build folder
#     outside.sh packages BUILD COMPONENTS…      the same from Debian packages of this build folder, unpacked into a scratch root
#     outside.sh source SOURCE COMPONENTS…       with add_subdirectory
#
# With an installation its programs, the tutorial and what tess_new makes are run, too. CXX is the compiler; MPIEXEC is empty where
# Tessera is built without MPI, PYTHON where it is without Python's module.
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
prefix=$scratch/prefix
if [[ $way == packages ]]; then
  cpack -G DEB --config "$from/CPackConfig.cmake" -B "$scratch/packages" >"$scratch/log" 2>&1 || { tail -20 "$scratch/log"; exit 1; }
  prefix=$scratch/root/usr
  for package in "$scratch"/packages/*.deb; do dpkg-deb -x "$package" "$scratch/root"; done
elif [[ $way == installed ]]; then
  cmake --install "$from" --prefix "$prefix" >"$scratch/log" 2>&1 || { tail -5 "$scratch/log"; exit 1; }
fi
if [[ $way != source ]]; then
  # As another machine has it: the source folder of the project is not looked at.
  if grep -rl "$(dirname "$(dirname "$here")")" "$prefix/lib/cmake" "$prefix/lib/pkgconfig" "$prefix/share" >"$scratch/leaks"; then
    echo "FAILED: the installation names the source folder: $(cat "$scratch/leaks")"
    exit 1
  fi
  options+=("-DCMAKE_PREFIX_PATH=$prefix")
  export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
else
  options+=("-DTESSERA=$from" -DBUILD_SHARED_LIBS=ON)  # with an installation they are static
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

# says PATTERN COMMAND…: the command ends well, and prints a line that matches.
says() {
  local pattern=$1
  shift
  if "$@" >"$scratch/out" 2>&1 && grep -Eq -- "$pattern" "$scratch/out"; then
    echo "ok: ${*##*/}"
  else
    echo "FAILED: $* does not print '$pattern': $(tail -5 "$scratch/out")"
    failed=1
  fi
}
if [[ $way == packages ]]; then
  name=_$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1/p' "$from/CPackConfig.cmake")_$(dpkg --print-architecture).deb
  says 'libc6 .*libopenmpi3' dpkg-deb -f "$scratch/packages/tessera-bin$name" Depends
  says 'libboost1.81-dev, libfmt-dev.*libopenmpi-dev' dpkg-deb -f "$scratch/packages/libtessera-dev$name" Depends
  says '^ Section: science$' dpkg-deb --info "$scratch/packages/tessera-bin$name"
  if [[ -n ${PYTHON:-} ]]; then
    says '^tour: [0-9]+ cells, 4 pictures$' env "PYTHONPATH=$prefix/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 \
      "$PYTHON" "$here/../python/tour.py" "$here/../../apps/python/TOUR.md"
  fi
fi
if [[ $way != source ]]; then
  for component in "${components[@]}"; do
    # shellcheck disable=SC2046
    "${CXX:-g++}" -std=c++20 -O0 "$here/outside/$component.cpp" -o "$scratch/by_pkg_config" $(pkg-config --cflags --libs "tessera-$component") || failed=1
    prints "${answers[$component]}" "$scratch/by_pkg_config"
  done
  says '^hello \(Tessera\) [0-9.]+, commit [0-9a-z-]+, preset ' "$prefix/bin/hello" --version
  says '^tess_monitor \(Tessera\) ' "$prefix/bin/tess_monitor" --version
  says '^ *linear' "$prefix/bin/m2m_transfer" kuhn:4 kuhn:5 --fields linear --pes 2 --out "$scratch/moved.exo"
  says 'found +0 inside, 64 boundary, 0 snapped, 0 outside' "$prefix/bin/m2m_transfer" "$scratch/moved.exo" kuhn:3 --fields linear
  if [[ -e $prefix/bin/tutorial_01_hello ]] || ls "$prefix/bin" | grep -E '^test_'; then
    echo "FAILED: the tutorial or tests are installed as programs"
    failed=1
  fi
  cmake -S "$prefix/share/doc/tessera/examples" -B "$scratch/examples" "${options[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
  cmake --build "$scratch/examples" --target tutorial_01_hello tutorial_11_race >"$scratch/log" 2>&1 || { tail -40 "$scratch/log"; exit 1; }
  says 'says hello to Ada' "$scratch/examples/tutorial_01_hello" --pes 2
  says 'sum of squares' "$scratch/examples/tutorial_11_race" --pes 2
fi

# The project of README.md, with hello as its main.cpp; and what tess_new makes.
if [[ $way == installed ]]; then
  cd "$scratch"
  says '^wave: a program' "$prefix/bin/tess_new" wave
  for refusal in "wave:wave is there already" "2d:'2d' is no name" "a-b:'a-b' is no name" "class:'class' is no name" "test:'test' means" ":'' is no name" "--nmae:unknown option --nmae"; do
    code=0
    "$prefix/bin/tess_new" "${refusal%%:*}" 2>"$scratch/out" || code=$?
    says "^2 tess_new: error: ${refusal#*:}" echo "$code $(cat "$scratch/out")"
  done
  says '^Usage: tess_new NAME' "$prefix/bin/tess_new" --help
  says '^tess_new \(Tessera\) [0-9.]+$' "$prefix/bin/tess_new" --version
  cmake -S wave -B wave/build "${options[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
  cmake --build wave/build >"$scratch/log" 2>&1 || { tail -40 "$scratch/log"; exit 1; }
  says '^100% tests passed' ctest --test-dir wave/build
  says '^the blocks add up to 28$' wave/build/wave --pes 2
  says 'seeds 1 to 9|seeds 1..9|9 seeds' wave/build/wave --sim pes=4,migrate=0,seeds=1..9
  cp -r "$here/small" "$scratch/small"
  cp "$here/../../apps/hello/main.cpp" "$scratch/small/main.cpp"
  cmake -S "$scratch/small" -B "$scratch/small/build" "${options[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
  cmake --build "$scratch/small/build" >"$scratch/log" 2>&1 || { tail -40 "$scratch/log"; exit 1; }
  prints "element 0: hello after 0 hops" bash -c "'$scratch/small/build/my_program' --pes 2 | head -1"
fi
exit $failed
