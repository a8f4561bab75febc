// A formula in x, y, z given as text: read once by recursive descent into a list of steps for a
// stack, which evaluates without allocation. Pure and cheap to copy; an error names the position in
// the text.
//
//   sum     := product (('+' | '-') product)*        power := atom ('^' signed)?      right to
//   left: 2^3^2 = 2^9 product := signed (('*' | '/') signed)*          atom  := number | x | y | z
//   | pi | name '(' sum (',' sum)* ')' | '(' sum ')' signed  := ('+' | '-') signed | power -x^2 =
//   -(x^2)
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

class Expression {
 public:
  /// Functions: sin cos tan exp log sqrt abs (one argument), min max pow (two). Throws Error
  /// (bad_argument).
  explicit Expression(const std::string& text);
  [[nodiscard]] double operator()(const Point& p) const;

  enum class Op : std::uint8_t {
    number,
    x,
    y,
    z,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    sin,
    cos,
    tan,
    exp,
    log,
    sqrt,
    abs,
    min,
    max
  };
  struct Step {
    Op op;
    double number = 0;
  };
  static constexpr std::size_t deepest = 64;  ///< operands on the stack, and nesting of brackets

 private:
  std::vector<Step> steps_;
};

}  // namespace tess::m2m
