// expect: each element gets a copy of a broadcast
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(std::unique_ptr<int> /*x*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks.broadcast<&Block::set>(std::make_unique<int>(3));
}
