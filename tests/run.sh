#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests: release, then address and undefined-behaviour sanitizers, then the
# thread sanitizer (without mpi). `tests/run.sh release` runs one preset alone.
#
# Many tests wait more than they compute. So while the tests of a preset run, the next one is built at the lowest priority:
#
#   release: build | release: test                 | asan: test  | tsan: test
#                  | headers, tidy and asan: build | tsan: build |
set -euo pipefail
cd "$(dirname "$0")/.."

presets=("$@")
if ((${#presets[@]} == 0)); then presets=(release asan tsan); fi

bash cmake/setup.sh
bash cmake/lint.sh

mkdir -p build

jobs=$(nproc)
# stage NAME: what begins or has ended, and the seconds since the start.
stage() { printf '== %s (%d s)\n' "$1" "$SECONDS"; }
# logged LOG COMMAND…: prints the end of its output if it fails.
logged() {
  "${@:2}" >build/"$1".log 2>&1 || { tail -60 build/"$1".log; return 1; }
}
# build PRESET TARGET
build() {
  logged "$1" cmake --preset "$1" && logged "$1" cmake --build --preset "$1" --target "$2" -j "$jobs" || return 1
  stage "$1: $2 built"
}
# prepare I: what goes on while the tests of preset I run.
prepare() {
  renice -n 19 -p $BASHPID >/dev/null
  if [[ ${presets[$1]} == release ]]; then
    build release headers_alone && bash cmake/tidy.sh || return 1
    stage "release: tidy"
  fi
  if (($1 + 1 < ${#presets[@]})); then build "${presets[$1 + 1]}" all; fi
}

next=
trap 'if [[ -n $next ]]; then kill -- -"$next" 2>/dev/null || true; fi' EXIT
set -m  # the preparation is a process group, so that it can be ended as a whole

stage "${presets[0]}: build"
build "${presets[0]}" all
for i in "${!presets[@]}"; do
  prepare "$i" &
  next=$!
  stage "${presets[i]}: test"
  ctest --preset "${presets[i]}" -j "$jobs"
  stage "${presets[i]}: tested"
  wait "$next"
  next=
done
stage done
