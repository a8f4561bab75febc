// expect: an array with this type of index starts sparse: create<C>(tess::sparse)
#include "runtime/runtime.hpp"

class Counter : public tess::Chare<Counter, std::string> {};

void misuse() {
  tess::create<Counter>(tess::range(8));
}
