// expect: a group has all its members: none is created on demand
#include "runtime/runtime.hpp"

class Counter : public tess::Group<Counter> {
 public:
  void step() {}
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Counter::step, tess::create_home>>;
};

void misuse(tess::GroupProxy<Counter> counters) {
  counters[tess::PeId{0}].send<&Counter::step>();
}
