#!/usr/bin/env bash
# The tests, in three tiers; each installs what is missing first.
#   tests/run.sh        a quarter of an hour: format; one build with all checks; the tests that find planted bugs (tests/mutants.py), with 20
#                       seeds; misuse that must not compile; three programs with the address and undefined-behaviour sanitizers
#   tests/run.sh full   an hour, before a release: every test in release, tidy, each file alone, the core with the thread sanitizer
#   tests/run.sh soak   a night: every test with both sanitizers, long seeds, the planted bugs
set -euo pipefail
cd "$(dirname "$0")/.."

tier=${1:-quick}
case $tier in
  # Each stage, and its seconds on two cores.
  quick) plan=(packages 40 lint 15 build 600 tests 100 sanitized_build 120 sanitized_tests 60 files_alone 35) ;;
  full) plan=(packages 40 lint 15 build 800 files_alone 400 tidy 170 tests 950 tsan_build 250 tsan_tests 300) ;;
  soak) plan=(packages 40 build 800 tests 3600 tsan_build 600 tsan_tests 1200 seeds 3600 planted_bugs 3600) ;;
  *) echo "usage: tests/run.sh [full | soak]" >&2; exit 2 ;;
esac
jobs=$(nproc)
passed=0 failed=0 skipped=0
broken=()
mkdir -p build

# stage NAME COMMAND…: runs it; says how long the stages before took, and how long this and the later ones may take. The tier goes
# on after a stage that fails.
stage() {
  local name=$1 left=0 i
  shift
  for ((i = ${#plan[@]} - 2; i >= 0; i -= 2)); do
    left=$((left + plan[i + 1]))
    [[ ${plan[i]} != "$name" ]] || break
  done
  printf '== %s: %s (%d s so far, about %d s left)\n' "$tier" "$name" "$SECONDS" "$left"
  if "$@"; then return 0; fi
  broken+=("$name")
}
# needed NAME COMMAND…: likewise, but nothing is left to do if it fails.
needed() {
  local before=${#broken[@]}
  stage "$@"
  if ((${#broken[@]} > before)); then finish; fi
}
build() {  # PRESET TARGET…
  local preset=$1
  shift
  cmake --preset "$preset" >build/"$preset".log 2>&1 || { cat build/"$preset".log; return 1; }
  cmake --build --preset "$preset" --target "$@" -j "$jobs" >build/"$preset".log 2>&1 || { tail -60 build/"$preset".log; return 1; }
}
test_preset() {  # PRESET OPTION…
  local preset=$1 result=$PWD/build/$1.xml code=0
  shift
  rm -f "$result"
  ctest --preset "$preset" -j "$jobs" --output-junit "$result" "$@" || code=$?
  # The attributes of the result: tests, failures, and those that were skipped or disabled.
  number() { sed -nE "s/^[[:space:]]*$1=\"([0-9]+)\".*/\\1/p" "$result" 2>/dev/null | head -n 1; }
  local all=$(number tests) bad=$(number failures) not_run=$(($(number skipped || true) + $(number disabled || true)))
  passed=$((passed + ${all:-0} - ${bad:-0} - not_run)) failed=$((failed + ${bad:-0})) skipped=$((skipped + not_run))
  return $code
}
finish() {
  echo "== $tier: done after $SECONDS s"
  if ((${#broken[@]} > 0)); then echo "these stages failed: ${broken[*]}"; fi
  echo "$passed passed, $failed failed, $skipped skipped"
  exit $((${#broken[@]} > 0 || failed > 0 || passed == 0))
}

needed packages bash cmake/setup.sh
if [[ $tier == quick ]]; then
  export TESS_SEEDS=${TESS_SEEDS:-20}
  stage lint bash cmake/lint.sh
  needed build build check quick_tests
  stage tests test_preset check -L quick
  needed sanitized_build build asan sanitized_tests
  stage sanitized_tests test_preset asan -L sanitized
  stage files_alone bash cmake/files_alone.sh check 30
elif [[ $tier == full ]]; then
  stage lint bash cmake/lint.sh
  needed build build release all
  stage files_alone bash cmake/files_alone.sh release
  stage tidy bash cmake/tidy.sh
  stage tests test_preset release
  needed tsan_build build tsan quick_tests
  TESS_SEEDS=3 stage tsan_tests test_preset tsan -L quick -L runtime
else
  needed build build asan all
  stage tests test_preset asan
  needed tsan_build build tsan all
  stage tsan_tests test_preset tsan
  soak_seeds() { build release protocol_fuzz collide_fuzz && build/release/bin/protocol_fuzz --seeds 0:10000 && build/release/bin/collide_fuzz --seeds 0:10000; }
  stage seeds soak_seeds
  stage planted_bugs python3 tests/mutants.py
fi
finish
