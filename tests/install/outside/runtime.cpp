#include <runtime/balance.hpp>
#include <runtime/runtime.hpp>

class Cell : public tess::Chare<Cell> {
 public:
  void add(int factor, tess::Callback<int> target) {
    contribute(tess::sum, factor * index().x, target);
  }
};

tess::Task total() {
  const auto cells = tess::create<Cell>(tess::range(10));
  tess::print("sum ", co_await cells.reduce<&Cell::add>(2), "\n");
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, total);
}
