// A sender waits for room.
#include "runtime/more/room.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

namespace {

class Box : public tess::Chare<Box> {
 public:
  void put(int /*number*/) { ++n_put; }
  static inline int n_put = 0;  // one thread runs all simulated PEs
};

class Pusher : public tess::Chare<Pusher> {
 public:
  tess::Task push(tess::ArrayProxy<Box> boxes) {
    for (int number = 0; number < 3; ++number) {
      const auto to = boxes[index().x];
      co_await tess::room(to);
      to.send<&Box::put>(number);
    }
  }
};

}  // namespace

TEST_CASE("there is room for messages to an array that this PE does not know yet",
          "[runtime][order]") {
  Box::n_put = 0;
  tests::over_seeds(20, "pes=4,cost=100ns", [] {
    const auto boxes = tess::create<Box>(tess::range(8));
    const auto pushers = tess::create<Pusher>(tess::range(8));
    pushers.broadcast<&Pusher::push>(boxes);
  });
  CHECK(Box::n_put == 20 * 24);
}
