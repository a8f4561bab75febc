#!/usr/bin/env bash
# What the live view costs: `bench message` and a stencil without --monitor, with it, watched by one client, and watched by
# one that also shows the heat map of the array by load. The four take turns in one run, on one PE.
#
#     apps/bench/monitor_cost.sh [--built BIN] [--rounds N] [--steps N]
#
# Prints processor time, user and system, of each: the least and the median of the rounds, and the median of the rounds'
# ratios to the run without --monitor. The aim is a ratio of at most 1.01. Processor time is hardly disturbed by other
# programs, but caches and clock rates are: on a machine in use, compare with the ratio of `off_again`, which is the same as
# `off`. With --rounds 15 it takes about ten minutes.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin rounds=15 steps=400
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --rounds) rounds=${2:?--rounds takes a number}; shift 2 ;;
    --steps) steps=${2:?--steps takes a number}; shift 2 ;;
    --help | -h) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
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
# seconds VARIANT ARRAY COMMAND…: the processor time of the command in this variant.
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
  TIMEFORMAT='%U %S'
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
  awk '{ print $1 + $2 }' "$scratch/time"
}

variants=(off off_again on watched heat)
stencil=("$built/stencil" --pes 1 --size 1024 --blocks 64 --steps "$steps")
messages=("$built/bench" --pes 1 --repeat 3 message)
for ((round = 0; round < rounds; ++round)); do
  for variant in "${variants[@]}"; do
    time=$(seconds "$variant" Block "${stencil[@]}")
    echo "stencil $variant $round $time"
    if [[ $variant == heat ]]; then continue; fi  # the arrays of bench end too soon
    time=$(seconds "$variant" - "${messages[@]}")
    echo "message $variant $round $time"
  done
done >"$scratch/all"

# The median of the numbers on standard input.
median() { sort -g | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
printf '%-8s %-10s %10s %10s %10s\n' program variant least_s median_s ratio
for program in stencil message; do
  for variant in "${variants[@]}"; do
    grep "^$program $variant " "$scratch/all" | awk '{ print $4 }' >"$scratch/times" || continue
    ratio=$(awk -v p="$program" -v v="$variant" '$1 == p && $2 == "off" { off[$3] = $4 }
      $1 == p && $2 == v { of[$3] = $4 } END { for (round in of) print of[round] / off[round] }' "$scratch/all" | median)
    printf '%-8s %-10s %10.3f %10.3f %10.4f\n' "$program" "$variant" "$(sort -g "$scratch/times" | head -1)" \
      "$(median <"$scratch/times")" "$ratio"
  done
done
