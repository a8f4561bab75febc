// expect: a group's class derives from tess::Group; create() makes an array
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}
};

void misuse() {
  tess::create_group<Block>();
}
