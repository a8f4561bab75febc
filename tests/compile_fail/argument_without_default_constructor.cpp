// expect: the arguments of an entry method need default constructors
#include "runtime/runtime.hpp"

#include <vector>

struct Row {
  explicit Row(int size) : values(static_cast<std::size_t>(size)) {}
  std::vector<double> values;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(values);
  }
};

class Block : public tess::Chare<Block> {
 public:
  void take(const Row& /*row*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(Row(3));
}
