#!/usr/bin/env bash
# Keeps a run of bench: measures on one PE, two PEs and two processes, and writes the rows to
# apps/bench/results/MACHINE_tessera_COMMIT.csv. Run it on an idle machine.
#
#     apps/bench/keep.sh [--built BIN] [--into FOLDER] [NAME | --quick | --repeat N …]
#
# --built: the folder of the programs (default: build/release/bin). The rest is passed to bench.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
built=$root/build/release/bin into=$root/apps/bench/results
arguments=()
while (($# > 0)); do
  case $1 in
    --built) built=${2:?--built takes a folder}; shift 2 ;;
    --into) into=${2:?--into takes a folder}; shift 2 ;;
    --help | -h) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) arguments+=("$1"); shift ;;
  esac
done
mpirun=(mpirun --oversubscribe)
if ((EUID == 0)); then mpirun+=(--allow-run-as-root); fi

model=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -1)
machine="$(nproc) cores of ${model:-an unnamed processor}"
rows=$(
  "$built/bench" --pes 1 "${arguments[@]}"
  "$built/bench" --pes 2 "${arguments[@]}"
  "${mpirun[@]}" -n 2 "$built/bench" --pes 1 "${arguments[@]}"
)
mkdir -p "$into"
part=$(mktemp "$into/part.XXXXXX")
trap 'rm -f "$part"' EXIT
# bench's last three columns are its machine (in quotes), preset and commit.
awk -v machine="$machine" -v date="$(date +%F)" '
  BEGIN { print "name,median,unit,pes,ranks,system,version,machine,date,note" }
  /^name,/ { next }
  {
    split($0, halves, "\"")
    n = split(halves[1], a, ",")
    split(halves[3], build, ",")
    print a[1] "," a[2] "," a[3] "," a[n - 2] "," a[n - 1] ",Tessera,\"" build[3] ", " build[2] "\",\"" machine "\"," date ",spread " a[5]
  }' <<<"$rows" >"$part"
commit=$(awk -F'"' 'NR == 2 { sub(/, .*/, "", $2); print $2 }' "$part")
name=$(tr -cs 'A-Za-z0-9\n' '_' <<<"${model:-unnamed}" | tr 'A-Z' 'a-z' | sed 's/_*$//')
mv "$part" "$into/${name}_tessera_$commit.csv"
chmod a+r "$into/${name}_tessera_$commit.csv"
echo "keep: $(($(wc -l <"$into/${name}_tessera_$commit.csv") - 1)) rows in $into/${name}_tessera_$commit.csv"
