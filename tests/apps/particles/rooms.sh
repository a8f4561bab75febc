#!/usr/bin/env bash
# The rooms of the larger programs: each includes only rooms of lower floors. `rooms.sh ROOT` checks the tree at ROOT.
set -euo pipefail
cd "${1:?usage: rooms.sh ROOT}"
failed=0
n_includes=0

# floors PROGRAM ROOMS…: from the lowest floor up; rooms of one floor are joined by commas. The program's own folder is
# the top floor; OPEN are its headers that every room may include.
floors() {
  local program=$1 floor=0 room
  shift
  declare -A floor_of=()
  for rooms in "$@"; do
    floor=$((floor + 1))
    for room in ${rooms//,/ }; do floor_of[$room]=$floor; done
  done
  local top=$((floor + 1)) source header from to
  while IFS=: read -r source header; do
    header=${header#*\"}
    header=${header%%\"*}
    from=${source#apps/"$program"/}
    to=${header#apps/"$program"/}
    [[ $from == */* ]] && from=${from%%/*} || from=.
    [[ $to == */* ]] && to=${to%%/*} || to=.
    [[ $from == "$to" || " ${OPEN:-} " == *" ${header##*/} "* ]] && continue
    n_includes=$((n_includes + 1))
    if ((${floor_of[$to]:-$top} >= ${floor_of[$from]:-$top})); then
      echo "FAILED: $source includes $header, which is not on a lower floor"
      failed=$((failed + 1))
    fi
  done < <(grep -rnoH --include=*.hpp --include=*.cpp "#include \"apps/$program/[^\"]*\"" "apps/$program" | sed 's/:[0-9]*:/:/')
}

OPEN=options.hpp floors particles scene,stability audit simulation study output
floors lb_lab workload run cells,collision,particles output
echo "$n_includes includes between rooms, $failed upward or sideways"
((n_includes > 50 && failed == 0))
