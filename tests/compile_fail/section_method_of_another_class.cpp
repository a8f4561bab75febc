// expect: this entry method belongs to another class than the elements of this collection
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step() {}
};
class Cell : public tess::Chare<Cell> {
 public:
  void grow() {}
};

void misuse(const tess::SectionProxy<Block>& row) {
  row.broadcast<&Cell::grow>();
}
