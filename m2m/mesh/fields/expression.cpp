#include "m2m/mesh/fields/expression.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace tess::m2m {
namespace {

using Op = Expression::Op;

struct Function {
  std::string_view name;
  Op op;
  int n_arguments;
};
constexpr std::array functions{Function{"sin", Op::sin, 1}, Function{"cos", Op::cos, 1},
                               Function{"tan", Op::tan, 1}, Function{"exp", Op::exp, 1},
                               Function{"log", Op::log, 1}, Function{"sqrt", Op::sqrt, 1},
                               Function{"abs", Op::abs, 1}, Function{"min", Op::min, 2},
                               Function{"max", Op::max, 2}, Function{"pow", Op::power, 2}};

constexpr bool is_operand(Op op) {
  return op <= Op::z;
}
constexpr bool is_unary(Op op) {
  return op == Op::negate || (op >= Op::sin && op <= Op::abs);
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  std::vector<Expression::Step> parse() {
    sum();
    blanks();
    if (at_ != text_.size()) wrong("expected an operator");
    return std::move(steps_);
  }

 private:
  [[noreturn]] void wrong(std::string_view what) const {
    fail(ErrorCode::bad_argument, "expression '", text_, "', position ", at_ + 1, ": ", what,
         "; allowed are numbers, x y z pi, + - * / ^, brackets, sin cos tan exp log sqrt abs min "
         "max pow");
  }

  void emit(Op op, double number = 0) {
    depth_ += is_operand(op) ? 1 : is_unary(op) ? 0 : -1;
    if (depth_ > static_cast<int>(Expression::deepest)) wrong("nested too deeply");
    steps_.push_back({op, number});
  }

  void blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool take(char c) {
    blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) wrong(std::string("expected '") + c + "'");
  }

  void sum() {
    product();
    for (;;) {
      if (take('+')) {
        product();
        emit(Op::add);
      } else if (take('-')) {
        product();
        emit(Op::subtract);
      } else {
        return;
      }
    }
  }

  void product() {
    with_sign();
    for (;;) {
      if (take('*')) {
        with_sign();
        emit(Op::multiply);
      } else if (take('/')) {
        with_sign();
        emit(Op::divide);
      } else {
        return;
      }
    }
  }

  void with_sign() {
    if (++nesting_ > Expression::deepest) wrong("nested too deeply");
    if (take('-')) {
      with_sign();
      emit(Op::negate);
    } else if (take('+')) {
      with_sign();
    } else {
      atom();
      if (take('^')) {
        with_sign();
        emit(Op::power);
      }
    }
    --nesting_;
  }

  void atom() {
    blanks();
    if (take('(')) {
      sum();
      return expect(')');
    }
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (name == "x") return emit(Op::x);
    if (name == "y") return emit(Op::y);
    if (name == "z") return emit(Op::z);
    if (name == "pi") return emit(Op::number, std::numbers::pi);
    for (const Function& function : functions) {
      if (name != function.name) continue;
      expect('(');
      sum();
      if (function.n_arguments == 2) {
        expect(',');
        sum();
      }
      expect(')');
      return emit(function.op);
    }
    at_ = begin;
    wrong(name.empty() ? std::string("expected a value")
                       : "unknown name '" + std::string(name) + "'");
  }

  void number() {
    std::string_view rest = text_.substr(at_);
    const auto value = take_number<double>(rest);
    if (!value) wrong("expected a number");
    at_ = text_.size() - rest.size();
    emit(Op::number, *value);
  }

  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t nesting_ = 0;
  int depth_ = 0;
  std::vector<Expression::Step> steps_;
};

double binary(Op op, double a, double b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::min:
      return std::isnan(b) ? b : std::min(a, b);
    case Op::max:
      return std::isnan(b) ? b : std::max(a, b);
    default:
      return std::pow(a, b);
  }
}

double unary(Op op, double a) {
  switch (op) {
    case Op::negate:
      return -a;
    case Op::sin:
      return std::sin(a);
    case Op::cos:
      return std::cos(a);
    case Op::tan:
      return std::tan(a);
    case Op::exp:
      return std::exp(a);
    case Op::log:
      return std::log(a);
    case Op::sqrt:
      return std::sqrt(a);
    default:
      return std::abs(a);
  }
}

}  // namespace

Expression::Expression(const std::string& text) : steps_(Parser(text).parse()) {}

double Expression::operator()(const Point& p) const {
  std::array<double, deepest> stack;
  std::size_t n = 0;
  for (const Step& step : steps_) {
    if (step.op == Op::number) {
      stack[n++] = step.number;
    } else if (is_operand(step.op)) {
      stack[n++] = p[static_cast<std::size_t>(step.op) - static_cast<std::size_t>(Op::x)];
    } else if (is_unary(step.op)) {
      stack[n - 1] = unary(step.op, stack[n - 1]);
    } else {
      stack[n - 2] = binary(step.op, stack[n - 2], stack[n - 1]);
      --n;
    }
  }
  return stack[0];
}

}  // namespace tess::m2m
