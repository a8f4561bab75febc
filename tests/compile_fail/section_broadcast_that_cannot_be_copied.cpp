// expect: each element gets a copy of a broadcast's arguments, so they can be copied
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(std::unique_ptr<int> /*x*/) {}
};

void misuse(const tess::SectionProxy<Block>& row) {
  row.broadcast<&Block::set>(std::make_unique<int>(3));
}
