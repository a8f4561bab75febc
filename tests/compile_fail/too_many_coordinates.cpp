// expect: an index has one number for each axis, and no more
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index1> {};

void misuse(tess::ArrayProxy<Block> blocks) {
  (void)blocks[{0, 1}];
}
