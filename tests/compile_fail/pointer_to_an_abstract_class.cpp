// expect: a unique_ptr to an abstract class cannot be read: hold a std::variant
#include "runtime/runtime.hpp"

#include <memory>

class Shape {
 public:
  virtual ~Shape() = default;
  virtual double area() const = 0;
  template <class Ar>
  void serialize(Ar& /*ar*/) {}
};

class Block : public tess::Chare<Block> {
 public:
  void take(std::unique_ptr<Shape> /*shape*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(nullptr);
}
