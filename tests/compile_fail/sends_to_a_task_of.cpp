// expect: an entry method returns void or tess::Task
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  tess::TaskOf<int> size() { co_return 1; }
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::size>();
}
