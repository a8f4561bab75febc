#!/usr/bin/env bash
# How a job ends under mpirun: with the exit code and the line that it should, on all processes, within seconds.
#
#     job_ends.sh MPIEXEC JOB OTHER_JOB CHECKS
source "$(dirname "$0")/../support/checks.sh"
mpirun=("$1" "${mpirun_options[@]}")
job=$2
other=$3
# Generous: what is not found by itself never ends.
limit=30

slowest=0  # milliseconds from the ending to mpirun's return
verdict() {
  local what=$1 code=$2 want=$3 word=$4
  if [[ $code =~ ^($want)$ ]] && { [[ -z $word ]] || grep -q -- "$word" "$scratch/err"; }; then
    pass
    echo "ok: $what: exit code $code; $(grep -m 1 -- "$word" "$scratch/err")"
  else
    fail "$what: exit code $code, wanted $want and a line with '$word':"
    tail -20 "$scratch/err"
  fi
}

# ends CODE WORD ARGUMENTS…: the job ends with this code (a pattern) and says WORD on standard error.
ends() {
  local want=$1 word=$2
  shift 2
  timeout -k 5 $limit "${mpirun[@]}" "$@" >"$scratch/out" 2>"$scratch/err" </dev/null
  local code=$? begun
  begun=$(sed -n 's/^ends at //p' "$scratch/out" | sort -n | tail -1)
  [[ -z $begun ]] || slowest=$(($(date +%s%3N) - begun > slowest ? $(date +%s%3N) - begun : slowest))
  verdict "${*##*/}" $code "$want" "$word"
}

# once WORD: standard error has one line with WORD.
once() {
  local n
  n=$(grep -c -- "$1" "$scratch/err")
  if ((n == 1)); then
    pass
  else
    fail "'$1' stands in $n lines, not in one"
  fi
}

ends 1 "the bridge is out" -n 2 "$job" throw --pes 1
ends 1 "on PE 3, Actor\[3\], in Actor::act" -n 2 "$job" throw --pes 2
ends 2 "the dose is -1" -n 2 "$job" fail --pes 1
once "the dose is -1"
ends 2 "memory is exhausted on PE 1, Actor\[1\], in Actor::act" -n 2 "$job" memory --pes 1
ends 2 "memory is exhausted on PE 3" -n 2 "$job" memory --pes 2
once "memory is exhausted"
ends 1 "element 1 was told to" -n 2 "$job" check --pes 1
ends 1 "on PE 3, Actor\[3\], in Actor::act" -n 2 "$job" check --pes 2
ends 5 "" -n 2 "$job" exit --pes 1
ends 5 "" -n 2 "$job" exit --pes 2
ends 9 "" -n 2 "$job" codes=3,9 --pes 1
ends 9 "" -n 2 "$job" codes=9,3 --pes 1
ends 7 "" -n 2 "$job" codes=0,7 --pes 2
ends 7 "" -n 2 "$job" move --pes 1
ends 7 "" -n 2 "$job" move --pes 2
ends 2 "different programs" -n 1 "$job" exit --pes 1 : -n 1 "$other" exit --pes 1
once "different programs"
ends 2 "different numbers of PEs" -n 1 "$job" exit --pes 1 : -n 1 "$job" exit --pes 2
ends 2 "only some processes of this job were given --audit" -n 1 "$job" exit --pes 1 --audit : -n 1 "$job" exit --pes 1
once "error: "
ends 2 "only some processes of this job were given --monitor" -n 1 "$job" exit --pes 1 --monitor 0 : -n 1 "$job" exit --pes 1
once "error: "
ends 2 "different --message-memory" -n 1 "$job" exit --pes 1 --message-memory 1KiB : -n 1 "$job" exit --pes 1
once "error: "
# What one process alone cannot do ends the others.
ends 2 "--monitor 192.0.2.7:0" -n 2 "$job" exit --pes 1 --monitor 192.0.2.7:0 --monitor-token t
once "error: "
mkdir "$scratch/trace"
ends 2 "trace" -n 2 "$job" exit --pes 1 --trace "$scratch/trace"
once "error: "
for option in --stats "--trace $scratch/a.json"; do
  ends 2 "only some processes of this job were given ${option%% *}" -n 1 "$job" exit --pes 1 $option : -n 1 "$job" exit --pes 1
  once "error: "
done
# One trace of all processes, and its critical path; one sentence on what limits the run.
ends 7 "tessera: critical path: [1-9]" -n 2 "$job" move --pes 2 --stats --trace "$scratch/all.json"
once "stats: PEs wait .* of the time"
traced=$(python3 -c '
import json, sys
events = [e for e in json.load(open(sys.argv[1]))["traceEvents"] if e["ph"] == "X"]
sends = {e["bind_id"]: e for e in events if "flow_out" in e}
over = [(sends[e["bind_id"]], e) for e in events if "flow_in" in e and sends[e["bind_id"]]["pid"] != e["pid"]]
print(sorted({(e["pid"], e["tid"]) for e in events}), len(over) > 0, all(a["ts"] <= b["ts"] for a, b in over))
' "$scratch/all.json")
if [[ $traced == "[(0, 0), (0, 1), (1, 2), (1, 3)] True True" ]] && [[ ! -e $scratch/all.json.1 ]]; then pass; else fail "trace of two processes: $traced"; fi
# --pes on one of them: the others take that number, or say that theirs differs.
ends 5 "" -n 1 "$job" exit --pes 1 : -n 1 "$job" exit
ends 2 "different numbers of PEs" -n 1 "$job" exit --pes 64 : -n 1 "$job" exit
ends 2 "--hang-report: x is not a number" -n 1 "$job" exit --pes 3 : -n 1 "$job" exit --pes 3 --hang-report x
once "error: "
ends 2 "--hang-report: x is not a number" -n 1 "$job" exit --pes 1 : -n 1 "$job" exit --pes 1 --hang-report x
once "error: "
# The simulated machine is one process; with one process mpirun changes nothing.
ends 2 "job: error: --sim pes=2: each process of the job would simulate the whole machine; start .* without mpirun" -n 2 "$job" exit --sim pes=2
once "would simulate the whole machine"
ends 5 "" -n 1 "$job" exit --sim pes=2,cost=100ns
# An element whose serialize() forgets: within a process and between two.
if [[ ${4:-} == all ]]; then
  for pes in "-n 1 --pes 2" "-n 2 --pes 1"; do
    # shellcheck disable=SC2086
    set -- $pes
    ends 1 "Forgetful: member 2 of 2 (double) does not come back" "$1" "$2" "$job" forget "$3" "$4"
  done
else
  ends 0 "" -n 2 "$job" forget --pes 1
fi

# A process that is killed: mpirun notices, ends the others and names it.
timeout -k 5 $limit "${mpirun[@]}" -n 2 "$job" wait --pes 1 >"$scratch/out" 2>"$scratch/err" </dev/null &
run=$!
for ((i = 0; i < 300; ++i)); do
  grep -q "^PE 1 pid" "$scratch/out" && break
  sleep 0.1
done
kill -KILL "$(sed -n 's/^PE 1 pid //p' "$scratch/out")"
wait $run
verdict "process 1 is killed" $? "137" "rank 1 .* signal 9"

echo "the slowest ended within $slowest ms"
finish
