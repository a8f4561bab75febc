#!/usr/bin/env bash
# What a job says that hangs: by itself with --hang-report, and on SIGUSR1. One report for the whole job.
#
#     hang.sh PROGRAM [MPIEXEC]
source "$(dirname "$0")/../../../support/running_job.sh"
pes=2
n_pes=2
((${#mpirun[@]} == 0)) || n_pes=4
last=$((n_pes - 1))

pid_of() { sed -n "s/^PE $1 pid //p" "$scratch/out" | head -1; }
ends() {  # the job is ended by a signal
  kill -TERM $job
  wait $job
}

starts $n_pes cycle --hang-report 0.5 --pes $pes
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

starts $n_pes stuck --hang-report 0.5 --pes $pes
check "$what: names the entry method" says_in_time "tessera: hang: Worker\[PE $last\] on PE $last has been in Worker::get_stuck for "
check "$what: reports by itself" says_in_time "tessera: hang: no entry method has begun"
check "$what: says who does not answer" says_in_time "PE $last has not answered within 300 ms: Worker\[PE $last\] on PE $last has been in Worker::get_stuck"
ends

starts $n_pes works --hang-report 1 --pes $pes
sleep 3
check "$what: is not reported" [ "$(n_says 'tessera: hang:')" = 0 ]
kill -USR1 $job
check "$what: reports on SIGUSR1" says_in_time "tessera: SIGUSR1: "
ends

starts $n_pes lost --hang-report 0.5 --audit --pes $pes
check "$what: names the lost message" says_in_time "message 3 (Worker::take) from PE 0 to PE $last was sent and has not arrived"
ends

if ((${#mpirun[@]} != 0)); then
  starts $n_pes cycle --pes $pes
  kill -USR1 "$(pid_of 2)"
  check "$what: one process alone gets the signal" says_in_time "tessera: SIGUSR1: "
  check "$what: and all PEs report" says "cycle of replies: Worker\[PE 0\] waits for .*Worker\[PE $last\] waits for "
  ends
  # All PEs of process 1 are in an entry method: it is named from outside.
  pes=1 n_pes=2 last=1
  starts $n_pes stuck --hang-report 0.5 --pes $pes
  check "$what: the process names its entry method" says_in_time "tessera: hang: Worker\[PE 1\] on PE 1 has been in Worker::get_stuck"
  check "$what: process 0 says that process 1 is silent" says_in_time "process 1 has not answered"
  kill -USR1 $job
  check "$what: the process reports itself" says_in_time "process 1 reports itself, since process 0 has not answered"
  ends
  # Process 0 asks again and again whether the job hangs, and process 1 says that it does not.
  n_pes=3
  mpirun=("$2" "${mpirun_options[@]}" -n 3)
  starts $n_pes mixed --hang-report 0.5 --pes $pes
  for n in 1 2 3; do
    kill -USR1 "$(pid_of 0)"
    check "$what: SIGUSR1, time $n" says_times $n "tessera: SIGUSR1: "
  done
  ends
fi

what="ends --audit"
"${mpirun[@]}" "$program" ends --audit --hang-report 60 --pes $pes >"$scratch/out" 2>&1
check "$what: exit code 0" [ $? = 0 ]
check "$what: each message arrived once" says "tessera: audit: [0-9]* messages between PEs, each of which arrived once"

check "a bad time is refused" [ "$("$program" cycle --hang-report soon 2>&1 | grep -c -- '--hang-report: soon is not a number of seconds')" = 1 ]
check "an audit beside a trace is refused" [ "$("$program" cycle --audit --trace t.json 2>&1 | grep -c -- 'both number the messages')" = 1 ]

finish
