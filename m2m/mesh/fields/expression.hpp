// A formula in x, y and z, given as text. A recursive-descent parser reads it once into steps for a
// stack machine, which evaluates without allocation. An Expression is cheap to copy. An error names
// its position in the text. (Expression libraries rewrite what they parse: muParser 2.3 gives other
// bits for x*0.1 + x*0.2 in half of all points, and for x^3 in a third. Here the operations are
// those of the text, in its order.)
//
//     sum     := product (('+' | '-') product)*
//     product := signed (('*' | '/') signed)*
//     signed  := ('+' | '-') signed | power            -x^2 is -(x^2)
//     power   := atom ('^' signed)?                    right to left: 2^3^2 is 2^9
//     atom    := number | 'x' | 'y' | 'z' | 'pi' | '(' sum ')' | name '(' sum (',' sum)? ')'
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

class Expression {
 public:
  /// Functions of one argument: sin cos tan exp log sqrt abs; of two: min max pow. Throws Error
  /// (bad_argument).
  explicit Expression(const std::string& text);
  [[nodiscard]] double operator()(const Point& p) const;

  // clang-format off
  enum class Op : std::uint8_t {
    number, x, y, z,
    negate, add, subtract, multiply, divide, power,
    sin, cos, tan, exp, log, sqrt, abs,
    min, max
  };
  // clang-format on
  struct Step {
    Op op;
    double number = 0;
  };
  static constexpr std::size_t deepest = 64;  ///< operands on the stack, and nested brackets

 private:
  std::vector<Step> steps_;
};

}  // namespace tess::m2m
