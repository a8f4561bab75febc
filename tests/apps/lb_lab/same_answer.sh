#!/usr/bin/env bash
# The answer of a laboratory run is the same bit for bit on threads, under mpirun and on the simulated machine, for every
# number of PEs and chares; the program itself compares every run with the serial answer.
source "$(dirname "$0")/../../support/checks.sh"
lab=$1/lb_lab
what=(--workload moving_hot_spot_comm,stencil,collision,particles --strategy greedy,graph --iterations 12 --period 3 --grain 5us)

# hashes PES COMMAND…: the program runs 32 cells' worth of chares on that many PEs, and all hashes are those of the first run.
hashes() {
  local per_pe=$((32 / $1))
  shift
  if timeout 100 "$@" "${what[@]}" --per-pe "1,$per_pe" --json "$scratch/run.json" >"$scratch/out" 2>&1; then
    grep -oE '^      "(workload|result_hash)": "[^"]*"' "$scratch/run.json" | paste - - | sort -u >"$scratch/now"
    [[ -e $scratch/first ]] || cp "$scratch/now" "$scratch/first"
    if [[ $(wc -l <"$scratch/now") -eq 4 ]] && cmp -s "$scratch/first" "$scratch/now"; then
      pass
      return
    fi
  fi
  fail "$*"
  tail -3 "$scratch/out"
  cat "$scratch/now"
}

hashes 1 "$lab" --pes 1
hashes 2 "$lab" --pes 2
hashes 4 "$lab" --pes 4 --when periodic
hashes 2 "$lab" --pes 2 --when automatic --speed 1,0.5
hashes 2 "${mpirun[@]}" -n 2 "$lab" --pes 1
hashes 4 "${mpirun[@]}" -n 2 "$lab" --pes 2 --when periodic
hashes 16 "$lab" --sim pes=16
for seed in 1 2 3; do hashes 8 "$lab" --sim "pes=8,seed=$seed,migrate=0.1"; done

finish
