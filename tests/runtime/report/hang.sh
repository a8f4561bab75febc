#!/usr/bin/env bash
# What a job says that hangs: by itself with --hang-report, and on SIGUSR1. One report for the whole job.
#
#     hang.sh PROGRAM [MPIEXEC]
set -uo pipefail
program=$1
mpirun=()
pes=2
n_pes=2
if [[ -n ${2:-} ]]; then
  mpirun=("$2" --allow-run-as-root --oversubscribe -n 2)
  n_pes=4
fi
last=$((n_pes - 1))
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
passed=0

check() {  # check WHAT CONDITION…
  local what=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $what"
    grep -v "^PE .* pid" "$scratch/out" | head -30
  fi
}
says() { grep -q -- "$1" "$scratch/out"; }
n_says() { grep -c -- "$1" "$scratch/out"; }
# says_in_time TEXT: within 20 s, since the machine may be loaded.
says_in_time() {
  local i
  for ((i = 0; i < 200; ++i)); do
    says "$1" && return 0
    sleep 0.1
  done
  return 1
}
pid_of() { sed -n "s/^PE $1 pid //p" "$scratch/out" | head -1; }

starts() {  # starts ARGUMENTS…: the job runs, and all PEs have announced themselves.
  local i
  : >"$scratch/out"
  "${mpirun[@]}" "$program" "$@" --pes $pes >"$scratch/out" 2>&1 </dev/null &
  job=$!
  for ((i = 0; i < 300; ++i)); do
    (($(grep '^PE .* pid' "$scratch/out" | sort -u | wc -l) >= n_pes)) && break
    sleep 0.1
  done
  what="$* ${mpirun[*]:+(2 processes)}"
}
ends() {  # the job is ended by a signal
  kill -TERM $job
  wait $job
}

starts cycle --hang-report 0.5
check "$what: reports by itself" says_in_time "tessera: hang: no entry method has begun on any PE for "
check "$what: names the cycle" says "cycle of replies: Worker\[PE 0\] waits for .*Worker\[PE $last\] waits for "
check "$what: says what waits" says "Worker\[PE $last\] on PE $last, at step 16: Worker::depth waits for the reply of Worker.*level"
check "$what: says what is set" says "PE 0: 1 timer is set"
kill -USR1 $job
check "$what: reports on SIGUSR1" says_in_time "tessera: SIGUSR1: "
sleep 1.5
check "$what: reports the hang once" [ "$(n_says 'tessera: hang:')" = 1 ]
check "$what: reports the signal once" [ "$(n_says 'tessera: SIGUSR1:')" = 1 ]
check "$what: goes on" kill -0 $job
ends

starts stuck --hang-report 0.5
check "$what: names the entry method" says_in_time "tessera: hang: Worker\[PE $last\] on PE $last has been in Worker::get_stuck for "
check "$what: reports by itself" says_in_time "tessera: hang: no entry method has begun"
check "$what: says who does not answer" says_in_time "PE $last has not answered within 300 ms: Worker\[PE $last\] on PE $last has been in Worker::get_stuck"
ends

starts works --hang-report 1
sleep 3
check "$what: is not reported" [ "$(n_says 'tessera: hang:')" = 0 ]
kill -USR1 $job
check "$what: reports on SIGUSR1" says_in_time "tessera: SIGUSR1: "
ends

starts lost --hang-report 0.5 --audit
check "$what: names the lost message" says_in_time "message 3 (Worker::take) from PE 0 to PE $last was sent and has not arrived"
ends

if ((${#mpirun[@]} != 0)); then
  starts cycle
  kill -USR1 "$(pid_of 2)"
  check "$what: one process alone gets the signal" says_in_time "tessera: SIGUSR1: "
  check "$what: and all PEs report" says "cycle of replies: Worker\[PE 0\] waits for .*Worker\[PE $last\] waits for "
  ends
  # All PEs of process 1 are in an entry method: it is named from outside.
  pes=1 n_pes=2 last=1
  starts stuck --hang-report 0.5
  check "$what: the process names its entry method" says_in_time "tessera: hang: Worker\[PE 1\] on PE 1 has been in Worker::get_stuck"
  check "$what: process 0 says that process 1 is silent" says_in_time "process 1 has not answered"
  kill -USR1 $job
  check "$what: the process reports itself" says_in_time "process 1 reports itself, since process 0 has not answered"
  ends
fi

what="ends --audit"
"${mpirun[@]}" "$program" ends --audit --hang-report 60 --pes $pes >"$scratch/out" 2>&1
check "$what: exit code 0" [ $? = 0 ]
check "$what: each message arrived once" says "tessera: audit: [0-9]* messages between PEs, each of which arrived once"

check "a bad time is refused" [ "$("$program" cycle --hang-report soon 2>&1 | grep -c -- '--hang-report: soon is not a number of seconds')" = 1 ]
check "an audit beside a trace is refused" [ "$("$program" cycle --audit --trace t.json 2>&1 | grep -c -- 'both number the messages')" = 1 ]

echo "$passed passed, $failed failed"
((failed == 0))
