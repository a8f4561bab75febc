// expect: a reply needs a default constructor
#include "runtime/runtime.hpp"

struct Sum {
  explicit Sum(int first) : value(first) {}
  int value;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(value);
  }
};

class Block : public tess::Chare<Block> {
 public:
  Sum sum() { return Sum(3); }
};

tess::Task misuse(tess::ArrayProxy<Block> blocks) {
  const Sum result = co_await blocks[{0}].ask<&Block::sum>();
  (void)result;
}
