// The program of runtime/FROM_CHARM.md: a rod of cells that cool. In each step a cell exchanges
// values with its neighbours and takes their mean; the largest change decides whether there is
// another step.
#include "runtime/runtime.hpp"

#include <cmath>

struct Value {
  int step = 0;
  double value = 0;
};

class Cell : public tess::Chare<Cell> {
 public:
  Cell() = default;
  explicit Cell(tess::Callback<int> done) : done_(done) {}

  tess::Task step() {
    const int x = index().x, last = static_cast<int>(array().size()) - 1;
    if (x > 0) array()[{x - 1}].send<&Cell::receive>(Value{step_, value_});
    if (x < last) array()[{x + 1}].send<&Cell::receive>(Value{step_, value_});
    double sum = x == 0 ? 1 : 0;
    for (int n = (x > 0) + (x < last); n > 0; --n) {
      const Value from = co_await values_.take(step_);
      sum += from.value;
    }
    const double change = std::abs(sum / 2 - value_);
    value_ = sum / 2;
    ++step_;
    contribute(tess::max, change, array().target<&Cell::decide>());
  }
  void receive(Value value) { values_.put(value); }
  void decide(double change) {
    if (change > 1e-6)
      self().send<&Cell::step>();
    else if (index().x == 0)
      done_(step_);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(step_, value_, values_, done_);
  }

 private:
  int step_ = 0;
  double value_ = 0;
  tess::Mailbox<&Value::step> values_;
  tess::Callback<int> done_;
};

tess::Task cool() {
  tess::Future<int> n_steps;
  const auto rod = tess::create<Cell>(tess::range(8), n_steps.callback());
  rod.broadcast<&Cell::step>();
  tess::print(co_await n_steps, " steps\n");
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, cool);
}
