// expect: the class of these elements does not implement the interface
#include "runtime/interface.hpp"
#include "runtime/runtime.hpp"

class Shape {
 public:
  virtual ~Shape() = default;
};
class Block : public tess::Chare<Block> {};

tess::InterfaceProxy<Shape> misuse(tess::ArrayProxy<Block> blocks) {
  return blocks[{0}];
}
