#!/usr/bin/env bash
# What the live view costs: `bench message` and a stencil without --monitor, with it, watched by one client, and watched by
# one that also shows the heat map of the array by load. The four take turns in one run, on one PE.
#
#     apps/bench/monitor_cost.sh [--built BIN] [--rounds N] [--steps N] [--times FILE]
#
# Prints for each the least and the median processor time, user and system, and the ratios to the run without --monitor:
# of the least processor times, and the medians over the rounds for processor time and wall time. The aim is a ratio of at
# most 1.01. `off_again` is the same as `off`: its ratios show how much of the others is noise. Every second round goes
# backwards, so a drift of the clock rate cancels. A round takes about 20 s. With --times FILE the times are appended to
# FILE and the table is that of all rounds in FILE, so that short runs at quiet moments add up.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin rounds=15 steps=400 times=
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --rounds) rounds=${2:?--rounds takes a number}; shift 2 ;;
    --steps) steps=${2:?--steps takes a number}; shift 2 ;;
    --times) times=${2:?--times takes a file}; shift 2 ;;
    --help | -h) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "monitor_cost: error: unknown option $1 (--help lists them)" >&2; exit 2 ;;
  esac
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# A client that follows the run from its beginning to its end: client HEAT…
client() {
  local at=
  while [[ -z $at && -e $scratch/runs ]]; do
    at=$(grep -o '127.0.0.1:[0-9]*' "$scratch/lines" || true)
    sleep 0.02
  done
  if [[ -n $at ]]; then "$built/tess_monitor" --connect "$at" "$@" >"$scratch/seen" 2>&1 || true; fi
}
# seconds VARIANT ARRAY COMMAND…: the processor time and the wall time of the command in this variant.
seconds() {
  local variant=$1 array=$2 watcher=
  shift 2
  local command=("$@")
  if [[ $variant != off* ]]; then command+=(--monitor 0); fi
  : >"$scratch/lines"
  touch "$scratch/runs"
  case $variant in
    watched) client & watcher=$! ;;
    heat) client --heat "$array" & watcher=$! ;;
  esac
  TIMEFORMAT='%U %S %R'
  { time "${command[@]}" >"$scratch/out" 2>"$scratch/lines"; } 2>"$scratch/time" || {
    echo "monitor_cost: error: it failed: ${command[*]}" >&2
    cat "$scratch/lines" >&2
    exit 1
  }
  rm "$scratch/runs"
  if [[ -n $watcher ]]; then wait "$watcher"; fi
  if [[ $variant == heat ]] && ! grep -q ' by load: hottest' "$scratch/seen"; then
    echo "monitor_cost: error: the client saw no heat map; give more --steps" >&2
    exit 1
  fi
  awk '{ print $1 + $2, $3 }' "$scratch/time"
}

variants=(off off_again on watched heat)
stencil=("$built/stencil" --pes 1 --size 1024 --blocks 64 --steps "$steps")
messages=("$built/bench" --pes 1 --repeat 1 message)
times=${times:-$scratch/all}
touch "$times"
past=$(grep -c '^stencil off ' "$times" || true)  # rounds of earlier runs
for ((round = past; round < past + rounds; ++round)); do
  turns=("${variants[@]}")
  if ((round % 2)); then turns=(heat watched on off_again off); fi
  for variant in "${turns[@]}"; do
    time=$(seconds "$variant" Block "${stencil[@]}")
    echo "stencil $variant $round $time" >>"$times"
    if [[ $variant == heat ]]; then continue; fi  # the arrays of bench end too soon
    time=$(seconds "$variant" - "${messages[@]}")
    echo "message $variant $round $time" >>"$times"
  done
done

# The median of the numbers on standard input.
median() { sort -g | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
# ratio PROGRAM VARIANT COLUMN: the median over the rounds of the ratio to the run without --monitor.
ratio() {
  awk -v p="$1" -v v="$2" -v c="$3" '$1 == p && $2 == "off" { off[$3] = $c }
    $1 == p && $2 == v { of[$3] = $c } END { for (round in of) if (round in off) print of[round] / off[round] }' "$times" | median
}
# column PROGRAM VARIANT: its processor times.
column() { awk -v p="$1" -v v="$2" '$1 == p && $2 == v { print $4 }' "$times" | sort -g; }
printf '%-8s %-10s %8s %8s %10s %10s %10s\n' program variant least_s median_s least median wall
for program in stencil message; do
  for variant in "${variants[@]}"; do
    least=$(column "$program" "$variant" | head -1)
    if [[ -z $least ]]; then continue; fi
    printf '%-8s %-10s %8.3f %8.3f %10.4f %10.4f %10.4f\n' "$program" "$variant" "$least" "$(column "$program" "$variant" | median)" \
      "$(awk -v a="$least" -v b="$(column "$program" off | head -1)" 'BEGIN { print a / b }')" \
      "$(ratio "$program" "$variant" 4)" "$(ratio "$program" "$variant" 5)"
  done
done
