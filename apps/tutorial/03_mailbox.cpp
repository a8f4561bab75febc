// Step 3: a coroutine that waits for messages. A rod of 8 cells, hot at its left end, cools to a
// straight line: in each step every cell takes the mean of its neighbours.
#include "runtime/runtime.hpp"

struct Value {
  int step = 0;
  double value = 0;
};

class Cell : public tess::Chare<Cell> {
 public:
  tess::Task run(int n_steps) {
    for (int step = 0; step < n_steps; ++step) {
      const int x = index().x;
      if (x > 0) array()[{x - 1}].send<&Cell::receive>(Value{step, value_});
      if (x + 1 < array().size()) array()[{x + 1}].send<&Cell::receive>(Value{step, value_});

      double sum = 0;
      if (x == 0) sum += 1;  // beyond the left end it is hot; beyond the right end it is 0
      const int n_neighbours = (x > 0) + (x + 1 < array().size());
      for (int i = 0; i < n_neighbours; ++i) {
        const Value from_neighbour = co_await values_.take(step);
        sum += from_neighbour.value;
      }
      value_ = sum / 2;
    }
    if (index().x == 0 || index().x == 7) tess::print("cell ", index().x, ": ", value_, "\n");
  }
  void receive(Value value) { values_.put(value); }

 private:
  double value_ = 0;
  tess::Mailbox<&Value::step> values_;  // a message waits here until its step is taken
};

int main(int argc, char** argv) {
  return tess::run(argc, argv,
                   [] { tess::create<Cell>(tess::range(8)).broadcast<&Cell::run>(1000); });
}
