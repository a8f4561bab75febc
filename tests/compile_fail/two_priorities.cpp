// expect: an entry method has one priority
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}
  using EntryAttributes = tess::Attributes<
      tess::EntryMethod<&Block::step, tess::Priority{1}, tess::inline_when_local, tess::expedited>>;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::step>();
}
