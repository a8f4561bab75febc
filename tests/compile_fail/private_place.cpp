// expect: place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)` and public
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
  static tess::PeId place(tess::Index1 index, std::int32_t n_pes) {
    return tess::PeId{index.x % n_pes};
  }
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
