// expect: unable to deduce
// expect of clang: no matching member function for call to 'send'
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void set(int /*x*/) {}
  void set(std::string /*name*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::set>(3);  // send<tess::overload<int>(&Block::set)>(3) is it
}
