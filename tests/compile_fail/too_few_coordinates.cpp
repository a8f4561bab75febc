// expect: an index has a number for each axis: array[{x, y}]
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index2> {};

void misuse(tess::ArrayProxy<Block> blocks) {
  (void)blocks[{1}];
}
