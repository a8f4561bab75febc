#!/usr/bin/env bash
# What the live view costs: the processor time of a stencil's step on one PE, of the whole process, with and without it.
#
#     apps/bench/monitor_cost.sh [--built BIN] [--seconds N] [--heat]
#
# watched   One run with --monitor. A client connects for 1.3 s and leaves for 1.3 s, in turns; each watched time is compared
#           with the mean of the unwatched ones before and after it, so a drift of the clock rate cancels. With --heat the
#           client also shows the heat map by load.
# on        Short runs without --monitor and with it, in turns, compared likewise.
# again     The same, both without --monitor: it shows the noise.
#
# Prints for each the number of comparisons, the mean difference in percent, and its standard error. N seconds (60) are
# spent on each. The client runs on another core, which should be idle.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin budget=60 heat=()
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --seconds) budget=${2:?--seconds takes a number}; shift 2 ;;
    --heat) heat=(--heat Block); shift ;;
    --help | -h) sed -n '2,14s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "monitor_cost: error: unknown option $1 (--help lists them)" >&2; exit 2 ;;
  esac
done
scratch=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$scratch"' EXIT
stencil=("$built/stencil" --pes 1 --size 1024 --blocks 64 --log-steps)

# table NAME: of the means on standard input, each odd one against its two neighbours.
table() {
  awk -v name="$1" '{ v[NR] = $1 }
    END {
      for (i = 2; i < NR; i += 2) { d = 100 * (2 * v[i] / (v[i - 1] + v[i + 1]) - 1); ++n; sum += d; square += d * d }
      if (n < 2) { print "monitor_cost: error: too short to compare; give more --seconds" > "/dev/stderr"; exit 1 }
      mean = sum / n
      printf "%-8s %12d %+12.2f %% %12.2f %%\n", name, n, mean, sqrt((square / n - mean * mean) / (n - 1))
    }'
}

# The run that is watched in turns; `turns` has the times at which each begins and ends.
watched() {
  local at= end
  "${stencil[@]}" --steps 1000000 --monitor 0 >"$scratch/steps" 2>"$scratch/lines" &
  local run=$!
  until at=$(grep -o '127.0.0.1:[0-9]*' "$scratch/lines"); do
    if ! kill -0 "$run" 2>/dev/null; then
      echo "monitor_cost: error: the run ended before it could be watched: $(tail -1 "$scratch/lines")" >&2
      exit 1
    fi
    sleep 0.02
  done
  sleep 1
  end=$((SECONDS + budget))
  while ((SECONDS < end)); do
    echo "$(date +%s.%N) $(sleep 1.3; date +%s.%N)" >>"$scratch/turns"
    { date +%s.%N | tr '\n' ' '; timeout 1.3 "$built/tess_monitor" --connect "$at" "${heat[@]}" >"$scratch/seen" 2>&1 || true; date +%s.%N; } >>"$scratch/turns"
    if ((${#heat[@]} > 0)) && ! grep -q ' by load: hottest' "$scratch/seen"; then
      echo "monitor_cost: error: the client saw no heat map" >&2
      exit 1
    fi
    sleep 0.2 # until the run knows that the client has left
  done
  echo "$(date +%s.%N) $(sleep 1.3; date +%s.%N)" >>"$scratch/turns"
  kill "$run"
  wait "$run" 2>/dev/null || true
  # The mean processor time of the steps that lie within each turn, but for its first fifth of a second.
  awk 'FILENAME ~ /turns$/ { from[++n] = $1 + 0.2; to[n] = $2; next }
    $1 == "step" {
      for (t += !t; t < n && $3 > to[t];) ++t
      if (last >= from[t] && $3 <= to[t]) { sum[t] += $4 - cpu; ++steps[t] }
      last = $3; cpu = $4
    }
    END { for (t = 1; t <= n && steps[t]; ++t) print sum[t] / steps[t] }' "$scratch/turns" "$scratch/steps" |
    table watched
}
# runs NAME OPTION…: short runs without and with the options, in turns.
runs() {
  local name=$1 end=$((SECONDS + budget)) which=0
  shift
  while ((SECONDS < end || which % 2 == 0)); do
    local options=()
    if ((which % 2)); then options=("$@"); fi
    which=$((which + 1))
    "${stencil[@]}" --steps 80 "${options[@]}" 2>"$scratch/lines" |
      awk '$1 == "step" { if (++n == 5) first = $4; last = $4 } END { print (last - first) / (n - 5) }'
  done | table "$name"
}

printf '%-8s %12s %14s %14s\n' what comparisons difference error
watched
runs on --monitor 0
runs again
