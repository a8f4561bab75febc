// expect: an argument would lose its sign
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void go(int /*steps*/) {}
};

// It fails with another sentence, which expect.py must report.
void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::go>(3.7);
}
