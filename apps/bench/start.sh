#!/usr/bin/env bash
# Times hello from its start to its exit, in one process and on two ranks, and beside it `mpirun -n 2 true`, in turns. Prints
# rows as bench does, in milliseconds: the median, the least, and the spread, (greatest - least) / median.
#
#     apps/bench/start.sh [--built BIN] [--repeat N]
#
# --built: the folder of the programs (default: build/release/bin). --repeat: runs that count, after one that warms up
# (default 11).
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin repeat=11
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --repeat) repeat=${2:?--repeat takes a number}; shift 2 ;;
    --help | -h) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "start.sh: error: $1 is unknown; --help lists the options" >&2; exit 2 ;;
  esac
done
if ! [[ $repeat =~ ^[1-9][0-9]{0,3}$ ]]; then
  echo "start.sh: error: --repeat $repeat: give a number from 1 to 9999" >&2
  exit 2
fi
mpirun=(mpirun --oversubscribe)
if ((EUID == 0)); then mpirun+=(--allow-run-as-root); fi

declare -A samples # microseconds, by row
# times ROW COMMAND…: adds the time of a run that counts to the row. A command that fails ends the script.
times() {
  local row=$1 begin=${EPOCHREALTIME/[.,]/}
  "${@:2}" >/dev/null
  local end=${EPOCHREALTIME/[.,]/}
  if ((run > 0)); then samples[$row]+="$((end - begin)) "; fi
}
for ((run = 0; run <= repeat; ++run)); do
  times start_one_process "$built/hello" --pes 1
  times start_two_ranks "${mpirun[@]}" -n 2 "$built/hello" --pes 1
  times start_mpirun_true "${mpirun[@]}" -n 2 true
done
echo "name,median,unit,least,spread"
for row in start_one_process start_two_ranks start_mpirun_true; do
  tr ' ' '\n' <<<"${samples[$row]% }" | sort -n | awk -v row=$row '
    { ms[NR] = $1 / 1000 }
    END {
      median = (ms[int((NR + 1) / 2)] + ms[int(NR / 2) + 1]) / 2
      printf "%s,%.4g,ms,%.4g,%.2f\n", row, median, ms[1], (ms[NR] - ms[1]) / median
    }'
done
