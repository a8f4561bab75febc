// expect: describe_state() of a chare is `std::string describe_state() const` and public
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  std::string describe_state() { return "at step 3"; }
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
