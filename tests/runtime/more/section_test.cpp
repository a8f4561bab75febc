// Sections as a user writes them; reductions with a finishing step and gather by index, over arrays
// and sections.
#include "runtime/more/section.hpp"

#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

namespace {

struct Mean {
  struct Part {
    double sum = 0;
    std::int64_t n = 0;
  };
  Part combine(Part a, const Part& b) const { return {a.sum + b.sum, a.n + b.n}; }
  double finish(Part all) const { return all.sum / static_cast<double>(all.n); }
};
using Squares = std::vector<std::pair<tess::Index1, std::int32_t>>;

class Cell : public tess::Chare<Cell> {
 public:
  void all_squares(tess::Callback<Squares> target) {
    contribute(tess::gather, index().x * index().x, target);
  }
  void mean_of_all(tess::Callback<double> target) {
    contribute(Mean{}, Mean::Part{1.0 * index().x, 1}, target);
  }
  void mean_of(tess::SectionProxy<Cell> section, const tess::Callback<double>& target) {
    contribute(section, Mean{}, Mean::Part{1.0 * index().x, 1}, target);
  }
  struct Request {
    tess::SectionProxy<Cell> section;
    tess::Callback<double> mean;
    tess::Callback<Squares> squares;
  };
  void ask(Request request) {
    contribute(request.section, tess::in_order(Mean{}), Mean::Part{1.0 * index().x, 1},
               request.mean);
    contribute(request.section, tess::gather, index().x * index().x, request.squares);
  }
  void serialize(auto& /*ar*/) {}
};

tess::Task reduce() {
  const auto cells = tess::create<Cell>(tess::range(10));
  tess::Future<Squares> squares, some_squares;
  tess::Future<double> mean, some_mean;
  cells.broadcast<&Cell::all_squares>(squares.callback());
  cells.broadcast<&Cell::mean_of_all>(mean.callback());
  const auto odd = tess::create_section_if(cells, [](tess::Index1 i) { return i.x % 2 == 1; });
  odd.broadcast<&Cell::ask>(Cell::Request{odd, some_mean.callback(), some_squares.callback()});
  const Squares all = co_await squares;
  REQUIRE(all.size() == 10);
  for (std::int32_t i = 0; i < 10; ++i)
    CHECK(all[static_cast<std::size_t>(i)] == std::pair(tess::Index1{i}, i * i));
  CHECK(co_await mean == 4.5);
  CHECK(co_await some_mean == 5.0);
  const Squares some = co_await some_squares;
  CHECK(some == Squares{{{1}, 1}, {{3}, 9}, {{5}, 25}, {{7}, 49}, {{9}, 81}});
  const double mean_again = co_await odd.reduce<&Cell::mean_of>(odd);
  CHECK(mean_again == 5.0);
  co_await tess::epoch([&] { odd.destroy(); });
}

/// Moves on request, and hears.
class Rider : public tess::Chare<Rider> {
 public:
  void hear() {}
  void ride_on() { migrate_to(tess::PeId{(tess::my_pe().value + 3) % tess::n_pes()}); }
  void serialize(auto& /*ar*/) {}
};
class CallCounter : public tess::Group<CallCounter> {
 public:
  void report(tess::Callback<std::uint64_t> target) {
    contribute(tess::sum, tess::statistics().messages, target);
  }
};

using Costs = std::vector<std::uint64_t>;

/// The messages of ten multicasts before the members move, and after.
tess::Task count_messages(Costs& costs) {
  const auto riders = tess::create<Rider>(tess::range(64));
  const auto counters = tess::create<CallCounter>(tess::each_pe);
  const auto all = tess::create_section_if(riders, [](tess::Index1) { return true; });
  for (int phase = 0; phase < 2; ++phase) {
    if (phase == 1) co_await tess::epoch([&] { riders.broadcast<&Rider::ride_on>(); });
    // The first multicasts find the members' places.
    for (int i = 0; i < 4; ++i) co_await tess::epoch([&] { all.broadcast<&Rider::hear>(); });
    tess::Future<std::uint64_t> before, after;
    counters.broadcast<&CallCounter::report>(before.callback());
    const std::uint64_t n_before = co_await before;
    for (int i = 0; i < 10; ++i) co_await tess::epoch([&] { all.broadcast<&Rider::hear>(); });
    counters.broadcast<&CallCounter::report>(after.callback());
    const std::uint64_t n_after = co_await after;
    costs.push_back(n_after - n_before);
  }
}

/// Each call moves the other members of the PE away, before or after their turn.
class Pusher : public tess::Chare<Pusher> {
 public:
  void hear(bool pushes) {
    ++n_heard_;
    if (!pushes) return;
    for (int x = 0; x < 8; ++x)
      if (x % 3 == 0 && x != index().x) array()[{x}].send<&Pusher::go>();
  }
  void go() { migrate_to(tess::PeId{(tess::my_pe().value + 1) % tess::n_pes()}); }
  void report(tess::Callback<std::vector<int>> target) {
    contribute(tess::in_order(tess::concatenate), std::vector<int>{n_heard_}, target);
  }
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Pusher::go, tess::inline_when_local>>;
  void serialize(auto& ar) { ar(n_heard_); }

 private:
  int n_heard_ = 0;
};

tess::Task push(std::vector<int>& heard) {
  const auto pushers = tess::create<Pusher>(tess::range(8));
  const auto all = tess::create_section_if(pushers, [](tess::Index1) { return true; });
  for (int i = 0; i < 12; ++i)
    co_await tess::epoch([&] { all.broadcast<&Pusher::hear>(i % 4 == 3); });
  heard = co_await pushers.reduce<&Pusher::report>();
}

/// A section ends before one of its indices has had an element, and before or after the message to
/// that index has reached its home.
tess::Task end_before_all_have_joined(bool at_once) {
  const auto riders = tess::create<Rider>(tess::range(2));
  const std::vector<tess::Index1> members{{0}, {1}, {99}};
  if (at_once) {
    co_await tess::epoch([&] {
      const auto section = tess::create_section(riders, members);
      section.broadcast<&Rider::hear>();
      section.destroy();
    });
  } else {
    const auto section = tess::create_section(riders, members);
    section.broadcast<&Rider::hear>();
    co_await tess::sleep(std::chrono::milliseconds(1));
    co_await tess::epoch([&] { section.destroy(); });
  }
}

}  // namespace

TEST_CASE("a section that ends waits for no index without an element", "[runtime][section]") {
  for (const bool at_once : {true, false}) {
    CAPTURE(at_once);
    tests::over_seeds(50, "pes=4,cost=100ns", [&] { return end_before_all_have_joined(at_once); });
  }
}

TEST_CASE("a member that another member's call moves away before its turn receives the multicast",
          "[runtime][section]") {
  for (int n_pes = 1; n_pes <= 4; ++n_pes) {
    INFO(n_pes << " PEs");
    std::vector<int> heard;
    const std::string keys = tess::text("pes=", n_pes, ",cost=100ns");
    REQUIRE(tests::run(keys, [&] { return push(heard); }).exit_code == 0);
    CHECK(heard == std::vector<int>(8, 12));
  }
}

TEST_CASE("once members have moved, multicasts cost as few messages as before",
          "[runtime][section]") {
  Costs costs;
  REQUIRE(tests::run("pes=8,cost=100ns", [&] { return count_messages(costs); }).exit_code == 0);
  INFO(costs[0] << " messages, after the members have moved " << costs[1]);
  CHECK(costs[1] < costs[0] + 64);  // one per member and multicast would be 640 more
}

TEST_CASE("reductions are finished at the root and gathered by index, over arrays and sections",
          "[runtime][section]") {
  tests::over_seeds(50, "pes=4,cost=100ns", &reduce);
}
