// expect: the condition of a section is a function of an index that returns bool
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index2> {
 public:
  void step() {}
};

void misuse(const tess::ArrayProxy<Block>& blocks) {
  (void)tess::create_section_if(blocks, [](tess::Index1 index) { return index.x == 0; });
}
