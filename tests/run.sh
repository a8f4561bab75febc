#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests: release, then address and undefined-behaviour sanitizers, then the
# thread sanitizer (without mpi). `tests/run.sh release` runs one preset alone.
# Tests wait for half of their time. Meanwhile the next preset is built, at the lowest priority.
set -euo pipefail
cd "$(dirname "$0")/.."

presets=("$@")
if ((${#presets[@]} == 0)); then presets=(release asan tsan); fi

bash cmake/setup.sh
bash cmake/lint.sh

mkdir -p build

jobs=$(nproc)
# stage NAME: what begins, and how long it has been going on.
stage() { printf '== %s (%d s)\n' "$1" "$SECONDS"; }
# build PRESET TARGET: prints nothing unless it fails.
build() {
  local log=build/$1.log
  cmake --preset "$1" >"$log" 2>&1 || { cat "$log"; exit 1; }
  cmake --build --preset "$1" --target "$2" -j "$jobs" >"$log" 2>&1 || { tail -60 "$log"; exit 1; }
}
# ahead PRESET NEXT: what can be done while the tests of a preset run. NEXT is empty after the last one.
ahead() {
  renice -n 19 -p "$BASHPID" >/dev/null
  if [[ $1 == release ]]; then
    stage "release: headers alone"
    build release headers_alone
    stage "release: tidy"
    bash cmake/tidy.sh
  fi
  if [[ -n $2 ]]; then
    stage "$2: build"
    build "$2" all
  fi
}

set -m # what goes ahead is a group of processes, which ends with this script
group=
trap '[[ -z $group ]] || kill -- "-$group" 2>/dev/null || true' EXIT
stage "${presets[0]}: build"
build "${presets[0]}" all
for i in "${!presets[@]}"; do
  stage "${presets[i]}: test"
  ahead "${presets[i]}" "${presets[i + 1]:-}" &
  group=$!
  ctest --preset "${presets[i]}" -j "$jobs"
  stage "${presets[i]}: tested"
  wait "$group"
  group=
done
stage "done"
