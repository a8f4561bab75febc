// expect: an aggregate that is also a container has members of its own
#include "runtime/runtime.hpp"

struct Named : std::vector<double> {
  std::string name;
};

class Block : public tess::Chare<Block> {
 public:
  void take(Named /*values*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(Named());
}
