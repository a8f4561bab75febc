// How many messages a collision sends from PE to PE.
#include "collide/collider.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

/// Owns boxes at the places of a row, which are in voxels of their own: client 0 has nine at each,
/// client 1 one.
class Street : public Chare<Street> {
 public:
  void submit(const Collider& collider, std::int32_t n_houses) {
    std::vector<Aabb> boxes;
    for (std::int32_t place = 0; place < n_houses; ++place)
      for (std::int32_t i = 0; i < (index().x == 0 ? 9 : 1); ++i)
        boxes.push_back({{2.0 * place, 0, 0}, {2.0 * place + 1, 1, 1}});
    collider.submit(Objects{owner_of(index()), static_cast<ModelId>(index().x), boxes});
  }
  void receive(const Hits& hits) { n_ += hits.pairs.size(); }
  void count(const Callback<std::uint64_t>& target) { contribute(sum, n_, target); }

 private:
  std::uint64_t n_ = 0;
};

/// How many messages PE 1 sends to PE 0 in a run with so many collisions, on two processes of one
/// PE.
unsigned long long n_sent(std::int32_t n_houses, std::int32_t n_collisions) {
  Setup setup = tests::setup_of("--sim=pes=2,per-process=1,cost=100ns");
  std::vector<std::string> lines;
  setup.options.statistics = true;
  setup.options.report = [&](const std::string& line) {
    if (line.starts_with("stats: PE ")) lines.push_back(line);  // the cost also leaves out work
  };
  std::uint64_t n_pairs = 0;
  const auto program = [&]() -> Task {
    Collider collider;
    ArrayProxy<Street> streets;
    co_await epoch([&] {
      collider =
          make_collider({.voxel_size = {2, 2, 2}, .rules = {.within_model = WithinModel::skip}});
      streets = create<Street>(range(2));
    });
    // No pair leaves the PE that finds it: PE 0, which has most of the objects.
    const HitReceivers to{report_to<&Street::receive>(streets), {}, Receivers::one_owner};
    for (std::int32_t i = 0; i < n_collisions; ++i) {
      co_await epoch([&] { streets.broadcast<&Street::submit>(collider, n_houses); });
      co_await collider.run(to);
    }
    n_pairs = co_await streets.reduce<&Street::count>();
  };
  REQUIRE(run(setup, [&] { return program(); }) == 0);
  REQUIRE(n_pairs == 9 * static_cast<std::uint64_t>(n_houses * n_collisions));
  REQUIRE(lines.size() == 2);
  unsigned long long n_run = 0, n = 0;
  REQUIRE(std::sscanf(lines[1].c_str(), "stats: PE 1 messages %llu sent %llu", &n_run, &n) == 2);
  return n;
}

/// In a collision whose voxels are there: the first one creates them, which takes messages of its
/// own.
unsigned long long n_sent_in_second(std::int32_t n_houses) {
  return n_sent(n_houses, 2) - n_sent(n_houses, 1);
}

}  // namespace

// A PE delivers the objects of 4 096 entries at a time. An epoch that lasts longer has some
// messages more.
TEST_CASE("a PE sends the objects of many voxels to another process in one message",
          "[collide][parallel]") {
  const auto of_ten = n_sent_in_second(10), of_thousand = n_sent_in_second(1000),
             of_many = n_sent_in_second(9000);
  CAPTURE(of_ten, of_thousand, of_many);
  CHECK(of_ten > 0);
  CHECK(of_thousand < of_ten + 10);
  CHECK(of_many < of_ten + 20);  // three portions
}
