// expect: an argument would lose digits
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void go(int /*steps*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::go>(3.7);
}
