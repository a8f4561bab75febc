#!/usr/bin/env bash
# Keeps a run of bench: measures on one PE, two PEs and two processes, and writes the rows to
# apps/bench/results/MACHINE_tessera_COMMIT.csv. Run it on an idle machine.
#
#     apps/bench/keep.sh [--built BIN] [--into FOLDER] [--program bench_collide] [NAME | --quick | --repeat N …]
#
# --built: the folder of the programs (default: build/release/bin). --program: another one than bench, of one process and one
# PE; its name stands in that of the file. The rest is passed to the program.
set -euo pipefail
shopt -s inherit_errexit # a run that fails ends the script, also within $(…)
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin into=$root/apps/bench/results
arguments=() program=bench
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --into) into=${2:?--into takes a folder}; shift 2 ;;
    --program) program=${2:?--program takes a name}; shift 2 ;;
    --help | -h) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) arguments+=("$1"); shift ;;
  esac
done
mpirun=(mpirun --oversubscribe)
if ((EUID == 0)); then mpirun+=(--allow-run-as-root); fi

model=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -1)
machine="$(nproc) cores of ${model:-an unnamed processor}"
# "Embree 3.13.5's rtcCollide …" in the list of rows, which not every program has.
version_of() { "$built/$program" --list | sed -n "s/.* $1 \([0-9.]*\)'s .*/\1/p" | head -1 || true; }
embree=$(version_of Embree) fcl=$(version_of FCL)
if [[ $program == bench ]]; then
  kept=tessera
  rows=$(
    "$built/bench" --pes 1 "${arguments[@]}"
    "$built/bench" --pes 2 "${arguments[@]}"
    "${mpirun[@]}" -n 2 "$built/bench" --pes 1 "${arguments[@]}"
  )
else
  kept=tessera_$program
  rows=$("$built/$program" "${arguments[@]}")
fi
mkdir -p "$into"
part=$(mktemp "$into/part.XXXXXX")
trap 'rm -f "$part"' EXIT
# bench's last three columns are its machine (in quotes), preset and commit.
awk -v machine="$machine" -v date="$(date +%F)" -v embree="$embree" -v fcl="$fcl" '
  BEGIN { print "name,median,unit,pes,ranks,system,version,machine,date,note" }
  /^(name,|#)/ { next }
  {
    split($0, halves, "\"")
    n = split(halves[1], a, ",")
    split(halves[3], build, ",")
    whose = "Tessera"; version = build[3] ", " build[2]
    if (a[1] ~ /_embree/) { whose = "Embree"; version = embree " in turns with Tessera " version }
    if (a[1] ~ /_fcl/) { whose = "FCL"; version = fcl " in turns with Tessera " version }
    print a[1] "," a[2] "," a[3] "," a[n - 2] "," a[n - 1] "," whose ",\"" version "\",\"" machine "\"," date ",least " a[4] " spread " a[5]
  }' <<<"$rows" >"$part"
commit=$(awk -F'"' '/,Tessera,/ { sub(/, .*/, "", $2); print $2; exit }' "$part")
name=$(tr -cs 'A-Za-z0-9\n' '_' <<<"${model:-unnamed}" | tr 'A-Z' 'a-z' | sed 's/_*$//')
mv "$part" "$into/${name}_${kept}_$commit.csv"
chmod a+r "$into/${name}_${kept}_$commit.csv"
echo "keep: $(($(wc -l <"$into/${name}_${kept}_$commit.csv") - 1)) rows in $into/${name}_${kept}_$commit.csv"
