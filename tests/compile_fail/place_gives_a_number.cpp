// expect: place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)`
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  static int place(tess::Index1 index, std::int32_t n_pes) { return index.x % n_pes; }
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
