// expect: a target is an entry method of one argument, or of none
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(int /*x*/, int /*y*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  (void)blocks[{0}].target<&Block::set>();
}
