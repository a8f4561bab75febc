// expect: a reply is a value: a function that is asked returns no reference
#include "runtime/runtime.hpp"

#include <vector>

class Block : public tess::Chare<Block> {
 public:
  const std::vector<int>& values() { return values_; }

 private:
  std::vector<int> values_;
};

void misuse(tess::ArrayProxy<Block> blocks) {
  (void)blocks[{0}].ask<&Block::values>();
}
