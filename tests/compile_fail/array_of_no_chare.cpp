// expect: create<C>() needs a class C that derives from tess::Chare<C, Index>
#include "runtime/runtime.hpp"

class Block {
 public:
  void step() {}
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
