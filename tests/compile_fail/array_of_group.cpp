// expect: a group is made by create_group()
#include "runtime/runtime.hpp"

class Counter : public tess::Group<Counter> {
 public:
  void step() {}
};

void misuse() {
  tess::create<Counter>(tess::range(8));
}
