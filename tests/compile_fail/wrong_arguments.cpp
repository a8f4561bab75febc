// expect: these arguments are not what the entry method takes
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(std::string /*name*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::set>(std::vector<int>(3));
}
