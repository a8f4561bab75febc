// expect: EntryAttributes names a function that is no member of its class
#include "runtime/runtime.hpp"

class Other : public tess::Chare<Other> {
 public:
  void step() {}
};

class Block : public tess::Chare<Block> {
 public:
  void step() {}
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Other::step, tess::expedited>>;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::step>();
}
