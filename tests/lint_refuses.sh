#!/usr/bin/env bash
# lint_refuses.sh layers|words|internals|test_names|pages ROOT: cmake/CHECK.sh (pages.py) accepts a small tree, and refuses it with each planted fault.
set -euo pipefail
check=$1 root=$2

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{cmake,runtime/core,runtime/pe,collide/serial,m2m,apps/hello,apps/bench,tests/runtime/core}
cd "$tree"

# The small tree; each fault is planted in it afresh.
sound() {
  cat >cmake/layers.txt <<'END'
runtime/core :
runtime/pe : runtime/core
runtime :
collide/serial : runtime/core
m2m/vocabulary m2m/mesh.cpp :
apps/hello : runtime
END
  echo '// A number.' >runtime/core/number.hpp
  echo '#include "runtime/core/number.hpp"' >runtime/pe/queue.hpp
  echo '#include "runtime/chare.hpp"' >apps/hello/main.cpp
  echo '#include "runtime/core/number.hpp"  // Elements, nowhere a person: whose, "whole".' >collide/serial/grid.cpp
  echo 'Pe& here = current_pe();' >apps/bench/inside.cpp
  echo 'int nobody = 0;' >m2m/mesh.cpp  # a name is not prose
  echo 'Says "who" in a quotation.' >m2m/README.md
  echo 'TEST_CASE("a number") {}' >tests/runtime/core/number_test.cpp
  echo 'int shared();' >tests/runtime/core/shared.cpp
  echo '# No header is excepted.' >tests/headers.txt
}
run_check() {
  case $check in
    layers) bash "$root/cmake/layers.sh" --root "$tree" ;;
    words) bash "$root/cmake/words.sh" "$tree"/*/*/*.[hc]pp "$tree"/m2m/* ;;
    internals) bash "$root/cmake/internals.sh" "$tree" ;;
    test_names) bash "$root/cmake/test_names.sh" "$tree" ;;
    pages) python3 "$root/cmake/pages.py" "$tree" ;;
  esac
}

n_failed=0
# refuses FILE LINE TEXT: with this line in the file the check fails, and its output contains the text.
refuses() {
  sound
  echo "$2" >"$1"
  if run_check >out 2>&1; then
    echo "accepted: $1: $2"
  elif ! grep -qF -- "$3" out; then
    echo "refused, but without \"$3\": $1: $2"
    cat out
  else
    rm -f "$1"
    return
  fi
  rm -f "$1"
  n_failed=$((n_failed + 1))
}

sound
run_check || { echo "refuses the sound tree"; exit 1; }
case $check in
  layers)
    refuses runtime/core/number.hpp '#include "runtime/pe/pe.hpp"' 'runtime/core may not include runtime/pe'
    refuses runtime/pe/queue.hpp '#include "runtime/arrays/typed/array_of.hpp"' 'runtime/pe may not include runtime/arrays'
    refuses runtime/pe/queue.hpp '#include "runtime/chare.hpp"' 'runtime/pe may not include runtime'
    refuses collide/serial/grid.cpp '#include "m2m/mesh.cpp"' 'collide/serial may not include m2m/vocabulary'
    refuses apps/hello/main.cpp '#include "runtime/pe/pe.hpp"' 'apps/hello may not include runtime/pe'
    refuses apps/hello/main.cpp '#include "tests/support/catch.hpp"' 'only tests include tests'
    mkdir runtime/new
    refuses runtime/new/room.hpp '#include "runtime/core/number.hpp"' 'has no line for runtime/new'
    # A table with a circle (each line names earlier lines only), with an arrow that nothing uses, and with a file that is gone.
    refuses cmake/layers.txt 'runtime/core : runtime/pe' 'runtime/core may not stand on runtime/pe'
    refuses collide/serial/grid.cpp '// Nothing.' 'nothing in collide/serial includes runtime/core'
    refuses cmake/layers.txt 'm2m/vocabulary m2m/gone.hpp :' 'there is no file m2m/gone.hpp'
    # A room that stands on its house's neighbour, which stands on the house.
    mkdir runtime/core/late
    echo '#include "runtime/pe/queue.hpp"' >runtime/core/late/user.hpp
    refuses cmake/layers.txt $'runtime/core :\nruntime/pe : runtime/core\nruntime/core/late : runtime/pe' 'a circle runs through the houses runtime/'
    rm -r runtime/core/late
    ;;
  words)
    refuses runtime/core/number.hpp '// Waits for nobody.' '"nobody" in:'
    refuses runtime/core/number.hpp 'int n = 0;  // the element Who sent it' '"who" in:'
    refuses apps/hello/main.cpp 'fail("the PE to whom it went");' '"whom" in:'
    refuses m2m/README.md 'Somebody has to ask.' '"somebody" in:'
    ;;
  internals)
    refuses apps/hello/main.cpp 'const auto here = tess::current_pe().id();' 'apps/hello/main.cpp:1:'
    refuses m2m/mesh.cpp 'if (current_pe_or_null() != nullptr) send();' 'm2m/mesh.cpp:1:'
    refuses collide/serial/grid.hpp 'void end(Pe& pe);' 'collide/serial/grid.hpp:1:'
    refuses apps/hello/main.cpp 'tess::detail::Meter* meter = nullptr;' 'runtime/here.hpp'
    ;;
  test_names)
    refuses tests/runtime/core/registry.cpp 'TEST_CASE("a name") {}' 'should end in _test.cpp'
    refuses tests/runtime/core/shared_test.cpp 'int shared();' 'holds no test case'
    refuses runtime/scan.hpp '// A scan.' 'no tests/runtime/scan_test.cpp'
    refuses tests/headers.txt 'runtime/scan' 'there is no runtime/scan.hpp'
    mkdir tests/elsewhere
    refuses tests/elsewhere/number_test.cpp 'TEST_CASE("a number") {}' 'there is no folder elsewhere'
    ;;
  pages)
    refuses m2m/README.md '[a page](../runtime/gone.md)' 'there is no ../runtime/gone.md'
    refuses m2m/README.md '[a heading](#gone)' 'README.md has no heading #gone'
    refuses m2m/README.md "|$(printf ' long%.0s' {1..40}) |" 'a row of 203 characters'
    ;;
  *)
    echo "unknown check $check"
    exit 2
    ;;
esac
exit $((n_failed > 0))
