// expect: an entry method takes at most two arguments: put more into one aggregate
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(int /*x*/, int /*y*/, int /*z*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::set>(1, 2, 3);
}
