// expect: a pointer means nothing in another process
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void look(const int* /*at*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks, const int* at) {
  blocks[{0}].send<&Block::look>(at);
}
