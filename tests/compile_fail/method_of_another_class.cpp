// expect: this entry method belongs to another class than the elements of this collection
#include "runtime/runtime.hpp"

class Other : public tess::Chare<Other> {
 public:
  void go() {}
};
class Block : public tess::Chare<Block> {};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Other::go>();
}
