// The sample of runtime/more/testing.hpp and runtime/guide/find_a_race.md, compiled and run.
// tests/samples/check.py compares the text.
#include "runtime/more/testing.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

namespace {

struct Versioned {
  int version = 0, value = 0;
};

class Entry : public tess::Chare<Entry> {
 public:
  void write(Versioned v) {
    if (v.version > kept_.version) kept_ = v;
  }
  [[nodiscard]] int read() { return kept_.value; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(kept_);
  }

 private:
  Versioned kept_;
};

tess::Task write_twice(int& found) {
  const auto entries = tess::create<Entry>(tess::range(4));
  co_await tess::epoch([&] {
    entries[{3}].send<&Entry::write>(Versioned{1, 10});
    entries[{3}].send<&Entry::write>(Versioned{2, 20});
  });
  const int value = co_await entries[{3}].ask<&Entry::read>();
  found = value;
}

}  // namespace

TEST_CASE("an entry keeps the newest value in any order", "[runtime][sample]") {
  tess::test::for_seeds(0, 200, [](std::uint64_t seed) {
    int found = 0;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> tess::Task { return write_twice(found); }).require_success();
    tess::test::expect(found == 20, "found ", found);
  });
}
