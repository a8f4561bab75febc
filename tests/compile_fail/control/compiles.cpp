// expect: an argument would lose digits
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void go(int /*steps*/) {}
};

// No misuse: expect.py must report that this file compiles.
void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::go>(3);
}
