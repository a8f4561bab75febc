// expect: an entry method returns void or tess::Task; ask<&C::f>() calls a function that returns a value
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  int size() { return 1; }
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::size>();
}
