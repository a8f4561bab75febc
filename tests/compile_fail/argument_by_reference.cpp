// expect: an entry method takes its arguments by value or const reference
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void fill(std::vector<double>& /*values*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::fill>(std::vector<double>(3));
}
