// expect: a chare that is created on demand needs a default constructor
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  explicit Block(int /*size*/) {}
  void go() {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send_or_create_here<&Block::go>();
}
