// expect: the indices of a section are of the array's type of index
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index2> {
 public:
  void step() {}
};

void misuse(const tess::ArrayProxy<Block>& blocks, const std::vector<tess::Index1>& indices) {
  (void)tess::create_section(blocks, indices);
}
