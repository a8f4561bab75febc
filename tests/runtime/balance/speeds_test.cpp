// PEs of different speeds: a load that one PE measured counts as work wherever the element goes,
// within a phase and through a checkpoint.
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/checkpoint.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

namespace {

using namespace tess;
using namespace std::chrono_literals;

constexpr int n_elements = 4;  // 0 and 1 on PE 0 of 2

class Traveller : public Chare<Traveller> {
 public:
  void work() { charge(8ms); }
  void turn() { migrate_to(PeId{1 - my_pe().value}); }
  void serialize(auto& /*ar*/) {}
};

struct State {
  ArrayProxy<Traveller> travellers;
};

/// Nothing costs time but charge(), and nothing migrates by itself.
const test::Machine two_pes{
    .pes = 2, .per_process = 2, .cost = 0ns, .reordering = 0, .migration = 0};

BalanceOptions with_speeds(std::vector<double> speeds) {
  BalanceOptions options;
  options.speeds = std::move(speeds);
  return options;
}

/// Moves nothing and keeps the loads that it sees, in milliseconds at speed 1.
balance::Strategy keep(std::vector<double>& loads) {
  return [&loads](const balance::Snapshot& s) {
    loads.clear();
    for (const auto load : s.elements.load) loads.push_back(std::round(load.seconds() * 1000));
    return s.elements.pe;
  };
}

Task turn_within_a_phase(std::vector<double>& loads) {
  const auto all = create<Traveller>(range(n_elements));
  const BalancerProxy balancer = start_balancing(all, with_speeds({4, 1}), keep(loads));
  co_await balancer.begin_phase();
  co_await epoch([&] { all.broadcast<&Traveller::work>(); });
  co_await epoch([&] { all.broadcast<&Traveller::turn>(); });
  co_await epoch([&] { all.broadcast<&Traveller::work>(); });
  co_await balancer.round();
}

Task save(std::string folder) {
  State state{create<Traveller>(range(n_elements))};
  (void)start_balancing(state.travellers, with_speeds({4, 1}));
  co_await epoch([&] { state.travellers.broadcast<&Traveller::work>(); });
  co_await checkpoint(folder, state);
}

Task place(std::string folder, std::vector<double> speeds, std::vector<double>& loads) {
  const auto state = co_await restart<State>(folder);
  const BalancerProxy balancer =
      start_balancing(state.travellers, with_speeds(speeds), keep(loads));
  co_await balancer.place_again();
}

}  // namespace

TEST_CASE("an element that migrates within a phase takes its work along, not its seconds",
          "[balance]") {
  std::vector<double> loads;
  two_pes.run([&] { return turn_within_a_phase(loads); }).require_success();
  // 8 ms at speed 4 and 8 at speed 1, whichever came first.
  CHECK(loads == std::vector<double>(n_elements, 40));
}

TEST_CASE("a checkpoint has work, which PEs of other speeds take up", "[balance][checkpoint]") {
  const test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  two_pes.run([&] { return save(folder); }).require_success();
  for (const auto& speeds : {std::vector<double>{4, 1}, {1, 2}, {1, 1}}) {
    std::vector<double> loads;
    two_pes.run([&] { return place(folder, speeds, loads); }).require_success();
    std::ranges::sort(loads);
    CHECK(loads == std::vector<double>{8, 8, 32, 32});
  }
}
