// expect: an attribute of an entry method is tess::inline_when_local
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Block::step, 5>>;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::step>();
}
