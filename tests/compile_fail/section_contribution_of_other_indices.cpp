// expect: the section is of an array with another type of index
#include "runtime/runtime.hpp"

class Cell : public tess::Chare<Cell, tess::Index2> {
 public:
  void grow() {}
};
class Block : public tess::Chare<Block> {
 public:
  void give(tess::SectionProxy<Cell> cells, tess::Callback<int> sum) {
    contribute(cells, tess::sum, 1, sum);
  }
};

void misuse(const tess::SectionProxy<Cell>& cells, const tess::ArrayProxy<Block>& blocks,
            const tess::Callback<int>& sum) {
  blocks.broadcast<&Block::give>(cells, sum);
}
