// expect: place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)`
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  static tess::PeId place(tess::Index1 index) { return tess::PeId{index.x % tess::n_pes()}; }
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
