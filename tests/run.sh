#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests; then those marked SANITIZED with the address and undefined-behaviour
# sanitizers, and with the thread sanitizer (without mpi). `tests/run.sh asan tsan` runs all tests of these presets, which
# takes an hour; `tests/run.sh release` runs one preset alone.
set -euo pipefail
cd "$(dirname "$0")/.."

presets=("$@")
sanitized=false
if ((${#presets[@]} == 0)); then
  presets=(release asan tsan)
  sanitized=true
fi

bash cmake/setup.sh
bash cmake/lint.sh

mkdir -p build

jobs=$(nproc)
# stage NAME: what begins, and how long it has been going on.
stage() { printf '== %s (%d s)\n' "$1" "$SECONDS"; }
for preset in "${presets[@]}"; do
  targets=(all)
  tests=()
  if [[ $preset == release ]]; then
    targets+=(files_alone)
  elif $sanitized; then
    targets=(sanitized_tests)
    tests=(-L sanitized)
  fi
  stage "$preset: build"
  cmake --preset "$preset" >build/"$preset".log 2>&1 || { cat build/"$preset".log; exit 1; }
  cmake --build --preset "$preset" --target "${targets[@]}" -j "$jobs" >build/"$preset".log 2>&1 || { tail -60 build/"$preset".log; exit 1; }
  if [[ $preset == release ]]; then
    stage "$preset: tidy"
    bash cmake/tidy.sh
  fi
  stage "$preset: test"
  ctest --preset "$preset" -j "$jobs" "${tests[@]}"
done
stage done
