// expect: an interface creates no element: its class is not known
#include "runtime/interface.hpp"
#include "runtime/runtime.hpp"

class Shape {
 public:
  virtual ~Shape() = default;
  virtual double area() = 0;
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Shape::area, tess::create_home>>;
};

void misuse(tess::InterfaceProxy<Shape> shape) {
  (void)shape.ask<&Shape::area>();
}
