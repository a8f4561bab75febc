# The head of a shell test that watches a program of four or fewer PEs from outside, on threads or under mpirun; the test
# sources this file with its own arguments, PROGRAM [MPIEXEC]. The program prints "PE 2 pid 4711" for each of its PEs.
#
#     check WHAT COMMAND…    counts whether the command succeeds
#     starts N ARGUMENTS…    starts the program as $job; its N PEs have announced themselves then
#     says TEXT              whether the job has printed it
#     says_in_time TEXT      the same, within 20 s, since the machine may be loaded
#     n_says TEXT            in how many lines
#     says_times N TEXT      whether it is in N lines within 20 s
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
program=$1
if [[ -n ${2:-} ]]; then
  mpirun=("$2" "${mpirun_options[@]}" -n 2)
else
  mpirun=()
fi

check() {
  local what=$1
  shift
  if "$@"; then
    pass
  else
    fail "$what"
    grep -v "^PE .* pid" "$scratch/out" | head -30
  fi
}
starts() {
  local n=$1 i
  shift
  : >"$scratch/out"
  "${mpirun[@]}" "$program" "$@" >"$scratch/out" 2>&1 </dev/null &
  job=$!
  for ((i = 0; i < 300; ++i)); do
    (($(grep '^PE .* pid' "$scratch/out" | sort -u | wc -l) >= n)) && break
    sleep 0.1
  done
  what="$* ${mpirun[*]:+(processes)}"
}
says() { grep -q -- "$1" "$scratch/out"; }
n_says() { grep -c -- "$1" "$scratch/out"; }
says_in_time() {
  local i
  for ((i = 0; i < 200; ++i)); do
    says "$1" && return 0
    sleep 0.1
  done
  return 1
}
says_times() {
  local i
  for ((i = 0; i < 200; ++i)); do
    (($(n_says "$2") >= $1)) && return 0
    sleep 0.1
  done
  return 1
}
