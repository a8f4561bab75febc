// expect: the value of a future needs a default constructor
#include "runtime/runtime.hpp"

struct Sum {
  explicit Sum(int first) : value(first) {}
  int value;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(value);
  }
};

tess::Task misuse() {
  tess::Future<Sum> sum;
  sum.callback()(Sum(3));
  const Sum result = co_await sum;
  (void)result;
}
