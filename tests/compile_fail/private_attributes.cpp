// expect: EntryAttributes is a public type of its class
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}

 private:
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Block::step, tess::expedited>>;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::step>();
}
