// expect: dead_letters of a chare is `static constexpr auto dead_letters = tess::DeadLetters::…` and public
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
  static constexpr auto dead_letters = tess::DeadLetters::wait;
};

void misuse() {
  tess::create<Block>(tess::range(8));
}
