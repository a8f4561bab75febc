#!/usr/bin/env bash
# header_weight.sh COMPILER ROOT: runtime.hpp by itself has at most so many preprocessed lines that are not blank. Each
# source of each program compiles them. What exceeds the limit belongs into a source, or behind a pointer.
set -euo pipefail
limit=66200
if ! "$1" --version | grep -q '(Debian 12\.'; then
  echo "skipped: the limit is for the standard library of g++ 12"
  exit 77
fi
lines=$(echo '#include "runtime/runtime.hpp"' | "$1" -std=gnu++20 -E -P "-I$2" -x c++ - | wc -l)
echo "runtime.hpp: $lines lines, at most $limit"
((lines <= limit))
