# The head of a shell test, which sources this file: a scratch folder that is removed at the end, mpirun with the options
# that tests need, and the counting of checks.
#
#     pass          counts a check that passed
#     fail WORDS…   counts a check that failed, and prints what failed
#     says PATTERN  checks that a line of $scratch/out, the output of the last command, matches
#     exits …       runs a command and checks its exit code and what it says; see below
#     same_results  succeeds if two JSON files of a program have the same results, on any machines and with any options
#     finish        prints the counts; succeeds if checks have passed and none has failed
set -uo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mpirun_options=(--allow-run-as-root --oversubscribe)
# What mpirun waits for, and no test looks at: networks to answer when a job starts (.2 s), and the processes of a job that
# fails to end by themselves (2 s; signals.sh does look at that).
export OMPI_MCA_pml=ob1 OMPI_MCA_btl=self,vader OMPI_MCA_odls_base_sigkill_timeout=0
mpirun=(mpirun -q "${mpirun_options[@]}")  # -q: mpirun's own messages are not printed
passed=0
failed=0

pass() { passed=$((passed + 1)); }
fail() {
  failed=$((failed + 1))
  echo "FAILED: $*"
}
says() {
  grep -Eq -- "$1" "$scratch/out" && pass && return
  fail "no line with '$1'"
  tail -5 "$scratch/out"
}
# exits CODE TEXT COMMAND…: requires this exit code within $limit s, and the text on either output; errors of the command
# line are one line.
limit=60
exits() {
  local want_code=$1 want=$2
  shift 2
  timeout "$limit" "$@" >"$scratch/out" 2>"$scratch/err" </dev/null
  local code=$?
  if [[ $code -eq $want_code ]] && grep -q -- "$want" "$scratch/out" "$scratch/err" &&
    { [[ $want_code -ne 2 ]] || [[ $(wc -l <"$scratch/err") -eq 1 ]]; }; then
    pass
  else
    fail "(exit $code, wanted $want_code and \"$want\"): $*"
    tail -n 3 "$scratch/out" "$scratch/err"
  fi
}
same_results() {
  [[ -s $1 && -s $2 ]] && cmp -s <(sed -n '/"results":/,$p' "$1") <(sed -n '/"results":/,$p' "$2")
}
finish() {
  echo "$passed passed, $failed failed"
  ((passed > 0 && failed == 0))
}
