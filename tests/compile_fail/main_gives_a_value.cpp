// expect: the function given to run() returns void or tess::Task: nothing would take a value
#include "runtime/runtime.hpp"

tess::TaskOf<int> count() {
  co_return 1;
}

int misuse(tess::Setup& setup) {
  return tess::run(setup, [] { return count(); });
}
