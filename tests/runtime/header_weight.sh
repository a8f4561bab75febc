#!/usr/bin/env bash
# header_weight.sh COMPILER ROOT: the headers that programs include have at most so many preprocessed lines that are not
# blank. Each source of each program compiles them. What exceeds a limit belongs into a source, or behind a pointer.
set -euo pipefail
limits=(
  runtime/runtime.hpp 66600
  collide/collider.hpp 72000
  m2m/coupling.hpp 74000
)
if [[ $("$1" --version) != *'(Debian 12.'* ]]; then
  echo "skipped: the limits are for the standard library of g++ 12"
  exit 77
fi
heavy=0
for ((i = 0; i < ${#limits[@]}; i += 2)); do
  header=${limits[i]} limit=${limits[i + 1]}
  lines=$(echo "#include \"$header\"" | "$1" -std=gnu++20 -E -P "-I$2" -x c++ - | wc -l)
  echo "$header: $lines lines, at most $limit"
  ((lines <= limit)) || heavy=1
done
exit $heavy
