// The sample of runtime/more/interface.hpp, compiled and run. tests/samples/check.py compares the text.
#include "runtime/more/interface.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

class Shape {
 public:
  virtual ~Shape() = default;
  virtual void grow(double by) = 0;
  [[nodiscard]] virtual double area() const = 0;
};
class Circle : public tess::Chare<Circle>, public Shape {
 public:
  void grow(double by) override { radius_ *= by; }
  [[nodiscard]] double area() const override { return 3 * radius_ * radius_; }

 private:
  double radius_ = 1;
};
class Square : public tess::Chare<Square>, public Shape {
 public:
  void grow(double by) override { side_ *= by; }
  [[nodiscard]] double area() const override { return side_ * side_; }

 private:
  double side_ = 1;
};

tess::Task grow(double& total) {
  const auto circles = tess::create<Circle>(tess::range(2));
  const auto squares = tess::create<Square>(tess::range(1));
  const std::vector<tess::InterfaceProxy<Shape>> shapes{circles[{0}], squares[{0}], circles[{1}]};
  co_await tess::epoch([&] {
    for (const auto& shape : shapes) shape.send<&Shape::grow>(2.0);
  });
  for (const auto& shape : shapes) {
    const double area = co_await shape.ask<&Shape::area>();
    total += area;
  }
}

}  // namespace

TEST_CASE("the sample of interfaces calls circles and squares", "[runtime][sample][interface]") {
  double total = 0;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return grow(total); }) == 0);
  CHECK(total == 28);
}
