// expect: the EntryAttributes of a chare are tess::Attributes<…>
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}
  using EntryAttributes = int;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::step>();
}
