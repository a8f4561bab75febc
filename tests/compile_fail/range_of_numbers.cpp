// expect: no matching function for call to
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index3> {};

void misuse() {
  tess::create<Block>({2, 2, 2});
}
