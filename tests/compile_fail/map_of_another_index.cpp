// expect: a map takes an index of the array and the number of PEs, and returns a tess::PeId
#include "runtime/index_map.hpp"
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block, tess::Index2> {};
struct ByNumber {
  tess::PeId operator()(const tess::Index1& index, std::int32_t n_pes) const {
    return tess::PeId{index.x % n_pes};
  }
};

void misuse() {
  (void)tess::create<Block>(tess::mapped(tess::range(4, 4), ByNumber{}));
}
