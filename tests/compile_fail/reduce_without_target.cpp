// expect: its last parameter is a tess::Callback<T>
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void step(tess::Callback<int> done, int n) { done(n); }
};

tess::Task misuse(tess::ArrayProxy<Block> blocks) {
  co_await blocks.reduce<&Block::step>(3);
}
