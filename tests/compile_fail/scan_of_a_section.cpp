// expect: a scan is over the elements of a whole array, not of a section
#include "runtime/runtime.hpp"
#include "runtime/scan.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step(tess::SectionProxy<Block> section) {
    contribute(section, tess::inclusive_scan(tess::sum), 1, self().target<&Block::take>());
  }
  void take(int /*sum*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks, tess::SectionProxy<Block> section) {
  blocks.broadcast<&Block::step>(section);
}
