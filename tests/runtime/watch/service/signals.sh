#!/usr/bin/env bash
# What a signal does to a run: SIGINT and SIGTERM end it on every process within 2 s with a census and exit code
# 128 + signal; SIGUSR1 prints the census and the run goes on.
#
#     signals.sh PROGRAM [MPIEXEC]
source "$(dirname "$0")/../../../support/running_job.sh"
export OMPI_MCA_odls_base_sigkill_timeout=1

pids() { sed -n 's/^PE .* pid //p' "$scratch/out" | sort -u; }
# A process that has ended may wait for mpirun to take note of it.
gone() {
  local pid state
  for pid in $(pids); do
    state=$(sed 's/.*) \(.\).*/\1/' "/proc/$pid/stat" 2>/dev/null) || continue
    [[ $state == Z ]] || return 1
  done
  return 0
}

# begins N ARGUMENTS…: starts the job, and gives the PEs time to wait for what they have asked for.
begins() {
  starts "$@"
  sleep 0.3
}
# mpirun takes a second to pass the signal on.
end_in_time() {
  local i
  for ((i = 0; i < tenths; ++i)); do
    gone && return 0
    sleep 0.1
  done
  return 1
}
ends() {  # ends EXIT_CODE [TENTHS_OF_SECONDS]
  local tenths=${2:-19}
  local code
  check "$what: every process ends within $tenths tenths of a second" end_in_time
  wait $job
  code=$?
  check "$what: exit code $1, not $code" [ "$code" = "$1" ]
}

if ((${#mpirun[@]} == 0)); then
  waiting="Waiter\[PE 1\] on PE 1: Waiter::wait waits for a message of key 7"
  for pair in TERM:143 INT:130; do
    begins 2 wait --pes 2
    kill -"${pair%:*}" $job
    ends "${pair#*:}"
    check "$what: says what ended it" says "SIG${pair%:*} ends the run; 3 wait:"
    check "$what: says what waits" says "$waiting"
    check "$what: says that a timer is set" says "PE 0: 1 timer is set"
  done
  begins 2 busy --pes 2
  kill -TERM $job
  ends 143
  begins 2 stuck --pes 2
  kill -TERM $job
  ends 143
  check "$what: names what runs" says "PE 1 has not answered within 300 ms: it runs Waiter::get_stuck"

  begins 2 wait --pes 2
  for n in 1 2; do
    kill -USR1 $job
    for ((i = 0; i < 50; ++i)); do
      (($(grep -c "SIGUSR1: 3 wait:" "$scratch/out") == n)) && break
      sleep 0.1
    done
    check "$what: SIGUSR1, time $n" [ "$(grep -c 'SIGUSR1: 3 wait:' "$scratch/out")" = $n ]
  done
  check "$what: goes on" kill -0 $job
  kill -TERM $job
  ends 143

  begins 2 ignore --pes 2
  kill -TERM $job
  sleep 0.5
  check "$what: a signal that the program ignores is left alone" kill -0 $job
  kill -INT $job
  ends 130
else
  # mpirun passes SIGTERM on after a second, kills its processes after another, and returns 1.
  begins 4 wait --pes 2
  kill -TERM $job
  ends 1 29
  check "$what: census of process 0" says "on process 0, 3 wait:"
  check "$what: census of process 1" says "on process 1, 2 wait:"
  check "$what: says what waits" says "Waiter\[PE 3\] on PE 3: Waiter::wait waits for a message of key 7"
  begins 4 stuck --pes 2
  kill -TERM $job
  ends 1 29
  check "$what: names what runs" says "PE 3 has not answered within 300 ms: it runs Waiter::get_stuck"

  # One process alone receives the signal: all report, and mpirun returns its exit code.
  begins 2 wait --pes 1
  kill -TERM "$(sed -n 's/^PE 1 pid //p' "$scratch/out")"
  ends 143
  check "$what: census of process 0" says "on process 0, 2 wait:"
  check "$what: census of process 1" says "on process 1, 1 wait:"

  begins 2 wait --pes 1
  kill -USR1 $job
  for ((i = 0; i < 50; ++i)); do
    says "SIGUSR1: 3 wait:" && break
    sleep 0.1
  done
  check "$what: SIGUSR1, one report of both processes" [ "$(grep -c 'SIGUSR1: 3 wait:' "$scratch/out")" = 1 ]
  check "$what: SIGUSR1, what waits on process 1" says "Waiter\[PE 1\] on PE 1: Waiter::wait waits for a message of key 7"
  check "$what: goes on" kill -0 $job
  kill -TERM $job
  ends 1 29

  # An idle process with two PEs, over 5 s, in ticks of 10 ms of processor time. One that polls takes all of a core.
  begins 4 wait --pes 2
  sleep 1
  ticks() { awk '{ sub(/.*\) /, ""); n += $12 + $13 } END { print n }' "/proc/$1/stat"; }
  declare -A before
  for pid in $(pids); do before[$pid]=$(ticks "$pid"); done
  sleep 5
  for pid in $(pids); do
    used=$(($(ticks "$pid") - before[$pid]))
    echo "an idle process with two PEs took $used of 500 ticks"
    check "an idle process takes less than a tenth of a core" [ $used -lt 50 ]
  done
  kill -TERM $job
  ends 1 29
fi

finish
