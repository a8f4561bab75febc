// expect: derive publicly from tess::Chare
#include "runtime/runtime.hpp"

class Block : tess::Chare<Block> {};

void misuse() {
  tess::create<Block>(tess::range(8));
}
