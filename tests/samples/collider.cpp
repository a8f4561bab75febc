// The samples of collide/collider.hpp, compiled and run. tests/samples/check.py compares the text.
#include "collide/collider.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

/// Owns one box. The boxes of all clients form a row in which each box overlaps the next.
class Client : public tess::Chare<Client, tess::Index1> {
 public:
  void submit(const tess::collide::Collider& collider) { collider.submit(boxes()); }
  void receive(const tess::collide::Hits& hits) { n_pairs_ += hits.pairs.size(); }
  void count(tess::Callback<std::uint64_t> target) {
    contribute(tess::sum, n_pairs_, std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_pairs_);
  }

 private:
  [[nodiscard]] std::vector<tess::collide::Item> boxes() const {
    const double x = index().x;
    return {{{{x, 0, 0}, {x + 1.5, 1, 1}}, {tess::collide::owner_of(index())}}};
  }
  std::uint64_t n_pairs_ = 0;
};

tess::Task find_pairs(std::uint64_t& n_pairs) {
  tess::collide::Collider collider;
  co_await tess::epoch([&] { collider = tess::collide::make_collider({}); });
  const auto clients = tess::create<Client>(tess::range(8));
  co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider); });
  co_await collider.run(tess::collide::report_to<&Client::receive>(clients));
  n_pairs = co_await clients.reduce<&Client::count>();
}

}  // namespace

TEST_CASE("the sample of collide/collider.hpp reports each of 7 pairs to both owners",
          "[collide][sample]") {
  std::uint64_t n_pairs = 0;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return find_pairs(n_pairs); }) == 0);
  CHECK(n_pairs == 2 * 7);
}

TEST_CASE("the sample of collide/collider.hpp stands any order of messages", "[collide][sample]") {
  tess::test::for_seeds(1, 41, [](std::uint64_t seed) {
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    std::uint64_t n_pairs = 0;
    machine.run([&]() -> tess::Task { return find_pairs(n_pairs); }).require_success();
    REQUIRE(n_pairs == 2 * 7);
  });
}
