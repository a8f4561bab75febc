// expect: a shared_ptr is not shared between processes: hold a unique_ptr
#include "runtime/runtime.hpp"

#include <memory>

class Block : public tess::Chare<Block> {
 public:
  void take(std::shared_ptr<int> /*value*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(std::make_shared<int>(3));
}
