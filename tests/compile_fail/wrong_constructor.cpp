// expect: the chare has no constructor that takes these arguments
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  Block() = default;
  explicit Block(std::string /*name*/) {}
};

void misuse() {
  tess::create<Block>(tess::range(8), std::vector<int>(3));
}
