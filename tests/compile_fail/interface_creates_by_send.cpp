// expect: an interface creates no element: its class is not known
#include "runtime/interface.hpp"
#include "runtime/runtime.hpp"

class Shape {
 public:
  virtual ~Shape() = default;
  virtual void grow() = 0;
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Shape::grow, tess::create_here>>;
};

void misuse(tess::InterfaceProxy<Shape> shape) {
  shape.send<&Shape::grow>();
}
