#!/usr/bin/env bash
# Refuses the runtime's inside in programs and libraries: they call public functions (runtime/here.hpp: my_pe(), n_pes(),
# now(), machine(), busy_time(), …), not current_pe(), and see neither a Pe nor its Meter. Only benchmarks measure the inside.
# `cmake/internals.sh [ROOT]` checks the tree at ROOT instead of this one.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

if found=$(grep -rnE --include='*.hpp' --include='*.cpp' '\bcurrent_pe(_or_null)?\b|\bPe\b|\bdetail::Meter\b' apps collide m2m |
  grep -v '^apps/bench/'); then
  echo "$found"
  echo "internals: these are of the runtime alone; use the functions of runtime/here.hpp"
  exit 1
fi
echo "internals: programs and libraries use public functions"
