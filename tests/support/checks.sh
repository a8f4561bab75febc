# The head of a shell test, which sources this file: a scratch folder that is removed at the end, mpirun with the options
# that tests need, and the counting of checks.
#
#     pass          counts a check that passed
#     fail WORDS…   counts a check that failed, and prints what failed
#     finish        prints the counts; succeeds if checks have passed and none has failed
set -uo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mpirun_options=(--allow-run-as-root --oversubscribe)
mpirun=(mpirun -q "${mpirun_options[@]}")  # -q: mpirun's own messages are not printed
passed=0
failed=0

pass() { passed=$((passed + 1)); }
fail() {
  failed=$((failed + 1))
  echo "FAILED: $*"
}
finish() {
  echo "$passed passed, $failed failed"
  ((passed > 0 && failed == 0))
}
