// expect: print() takes numbers, strings and what has an operator<< for std::ostream; it takes an
// index as index_text(index())
#include "runtime/runtime.hpp"

void misuse() {
  tess::print("element ", tess::Index2{1, 2}, "\n");
}
