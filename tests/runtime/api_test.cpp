// What a user may do with the public types, on two virtual processes in any order of messages.
#include "runtime/core/exact_sum.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <unordered_set>

namespace {

int run_seeded(std::optional<std::uint64_t> seed, const std::function<tess::Task()>& main) {
  tess::SimulatedOptions options;
  options.n_pes = 4;
  options.pes_per_process = 2;
  options.seed = seed;
  options.cost = tess::Time(100);
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine(options);
  setup.options.seed = seed.value_or(0);
  return tess::run(setup, main);
}
void over_seeds(const std::function<tess::Task()>& main) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    INFO("seed " << seed);
    REQUIRE(run_seeded(seed, main) == 0);
  }
}

/// a + b, in units of `unit`: an operation with a member.
struct InUnits {
  int unit = 1;
  int operator()(int a, int b) const { return (a / unit + b / unit) * unit; }
  friend bool operator==(const InUnits&, const InUnits&) = default;
};

class Node : public tess::Chare<Node> {
 public:
  Node() = default;
  explicit Node(tess::ElementProxy<Node, tess::Index1> next) : next_(next) {}
  void add(int unit, tess::Callback<int> target) { contribute(InUnits{unit}, 25, target); }
  void add_in_order(int unit, tess::Callback<int> target) {
    contribute(tess::in_order(InUnits{unit}), 25, target);
  }
  static double summand(int i) { return std::ldexp(1.0 / (1 + i), 7 * (i % 9)); }
  void add_exactly(tess::Callback<tess::ExactSum> target) {
    tess::ExactSum own;
    own.add(summand(index().x));
    contribute(tess::AddExactSums{}, own, target);
  }
  void there(tess::Callback<void> target) { contribute(target); }
  void follow(tess::ElementProxy<Node, tess::Index1> other) { next_ = other; }
  void pass(tess::Callback<int> target) {
    if (next_ == tess::ElementProxy<Node, tess::Index1>()) return target(index().x);
    next_.send<&Node::pass>(target);
  }
  void four(int a, std::string b, double c, std::vector<int> d, tess::Callback<double> target) {
    target(a + static_cast<double>(b.size()) + c + static_cast<double>(d.size()));
  }
  void set(int value) { value_ = value; }
  void set(std::string name) { value_ = static_cast<int>(name.size()); }
  void tell(tess::Callback<int> target) { target(value_); }
  void large(std::uint64_t n) { value_ = static_cast<int>(n); }
  void begin() {
    result_ = tess::Future<int>();
    const tess::Task waiting = wait();
    self().send<&Node::finish>(result_.callback());
  }
  tess::Task wait() { value_ = co_await result_; }
  void finish(tess::Callback<int> target) { target(77); }
  [[nodiscard]] int value() const { return value_; }

 private:
  tess::ElementProxy<Node, tess::Index1> next_;
  tess::Future<int> result_;
  int value_ = 0;
};

class Greeter : public tess::Group<Greeter> {
 public:
  void hello(tess::MemberProxy<Greeter> from, tess::Callback<int> target) {
    contribute(tess::sum, from == group()[tess::PeId{0}] ? 1 : 0, target);
  }
  void add(int value) { n_ += value; }
  [[nodiscard]] int n() { return n_; }

 private:
  int n_ = 0;
};

/// Has no default constructor.
class Named : public tess::Chare<Named> {
 public:
  explicit Named(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] std::string name() const { return name_; }

 private:
  std::string name_;
};

/// Is told to move and to end.
class Summoned : public tess::Chare<Summoned> {
 public:
  void go(tess::PeId pe) { migrate_to(pe); }
  void end() { destroy(); }
  void count(tess::Callback<int> target) { contribute(tess::sum, 1, target); }
  [[nodiscard]] tess::PeId pe() { return tess::my_pe(); }
  tess::Task rest() {
    (void)co_await self().ask<&Summoned::pe>();
    ++n_rests_;
  }
  [[nodiscard]] int n_rests() { return n_rests_; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_rests_);
  }

 private:
  int n_rests_ = 0;
};

tess::Task call_two(bool in_any_order) {
  const auto summoned = tess::create<Summoned>(tess::range(8));
  co_await tess::epoch([&] {
    summoned.local({0})->go(tess::PeId{3});
    summoned.local({1})->end();
  });
  if (!in_any_order) {  // otherwise it may have gone on
    const tess::PeId pe = co_await summoned[0].ask<&Summoned::pe>();
    CHECK(pe == tess::PeId{3});
  }
  const int left = co_await summoned.reduce<&Summoned::count>();
  CHECK(left == 7);
}

tess::Task call_coroutine() {
  const auto summoned = tess::create<Summoned>(tess::range(8));
  co_await tess::epoch([&] {
    const tess::Task rests = summoned.local({0})->rest();
    summoned[0].send<&Summoned::go>(tess::PeId{3});
  });
  const int n = co_await summoned[0].ask<&Summoned::n_rests>();
  CHECK(n == 1);
}

class Cube : public tess::Chare<Cube, tess::Index3> {};

}  // namespace

TEST_CASE("the state of a reduction's operation travels", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(6));
    tess::Future<int> merged, ordered;
    nodes.broadcast<&Node::add>(10, merged.callback());
    CHECK(co_await merged == 120);
    nodes.broadcast<&Node::add_in_order>(10, ordered.callback());
    CHECK(co_await ordered == 120);
  });
}

TEST_CASE("the greatest and least of values with NaN are NaN, in every order", "[api]") {
  const double nan = std::nan("");
  for (const auto& [a, b] : {std::pair(nan, 1.0), {1.0, nan}, {nan, nan}}) {
    CHECK(std::isnan(tess::max(a, b)));
    CHECK(std::isnan(tess::min(a, b)));
  }
  CHECK(tess::max(1.0, 2.0) == 2);
  CHECK(tess::min(std::vector<double>{1, nan}, std::vector<double>{0, 5})[0] == 0);
  CHECK(std::isnan(tess::min(std::vector<double>{1, nan}, std::vector<double>{0, 5})[1]));
}

TEST_CASE("a reduction of exact sums has the same bits in every order", "[api]") {
  constexpr int n = 40;
  double rounded = 0;
  tess::ExactSum exact;
  for (int i = n - 1; i >= 0; --i) {
    exact.add(Node::summand(i));
    rounded += Node::summand(i);
  }
  CHECK(rounded != exact.total());
  over_seeds([&exact]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(n));
    const tess::ExactSum all = co_await nodes.reduce<&Node::add_exactly>();
    CHECK(all.total() == exact.total());
  });
}

TEST_CASE("an element's proxy is a value: empty, compared, hashed, sent, kept", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(5));
    for (int i = 0; i < 4; ++i) nodes[{i}].send<&Node::follow>(nodes[{i + 1}]);
    co_await tess::epoch([] {});
    const std::unordered_set<tess::ElementProxy<Node>> set{nodes[{1}], nodes[{2}], nodes[{1}]};
    CHECK(set.size() == 2);
    const std::map<tess::ElementProxy<Node>, int> map{{nodes[{1}], 1}, {nodes[{0}], 0}};
    CHECK(map.begin()->second == 0);
    CHECK(std::unordered_set<tess::ArrayProxy<Node>>{nodes, nodes}.size() == 1);
    co_await tess::epoch([&] {
      for (int i = 0; i < 4; ++i) nodes[{i}].send<&Node::follow>(nodes[{i + 1}]);
    });
    tess::Future<int> last;
    nodes[{0}].send<&Node::pass>(last.callback());
    CHECK(co_await last == 4);

    const auto members = tess::create_group<Greeter>();
    tess::MemberProxy<Greeter> from;
    CHECK(from != members[tess::PeId{1}]);
    from = members[tess::PeId{0}];
    const int n_greeted = co_await members.reduce<&Greeter::hello>(from);
    CHECK(n_greeted == tess::n_pes());
    CHECK(std::unordered_set<tess::MemberProxy<Greeter>>{from, members[tess::PeId{1}]}.size() == 2);
  });
}

TEST_CASE("a result without a value: futures, targets, reductions", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(7));
    tess::Future<void> there;
    nodes.broadcast<&Node::there>(there.callback());
    co_await there;

    // A target that takes no value: begin() makes a member future, whose result sets the value.
    co_await tess::epoch([&] { nodes[{3}].target<&Node::begin>()(); });
    tess::Future<int> value;
    nodes[{3}].send<&Node::tell>(value.callback());
    CHECK(co_await value == 77);
    co_await tess::epoch([&] { nodes.target<&Node::begin>()(); });
    tess::Future<int> last;
    nodes[{6}].send<&Node::tell>(last.callback());
    CHECK(co_await last == 77);

    const auto members = tess::create_group<Greeter>();
    const tess::Callback<int> all = members.target<&Greeter::add>();
    co_await tess::epoch([&] { all(5); });
    for (int pe = 0; pe < tess::n_pes(); ++pe) {
      const int n = co_await members[tess::PeId{pe}].ask<&Greeter::n>();
      CHECK(n == 5);
    }
  });
}

TEST_CASE("reduce() broadcasts and gives the future of the result, for now or for later", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(4));
    const auto members = tess::create_group<Greeter>();
    const int merged = co_await nodes.reduce<&Node::add>(1);
    CHECK(merged == 100);
    co_await nodes.reduce<&Node::there>();

    auto first = nodes.with(tess::expedited).reduce<&Node::add_in_order>(2);
    auto second = members.reduce<&Greeter::hello>(members[tess::PeId{0}]);
    CHECK(co_await second == tess::n_pes());
    CHECK(co_await first == 96);

    // One element may also give the result by itself. The arguments have memory of their own.
    const auto one = tess::create<Node>(tess::range(1));
    const double all =
        co_await one.reduce<&Node::four>(1, std::string(40, 'x'), 0.5, std::vector<int>(3));
    CHECK(all == 44.5);
  });
}

namespace {
tess::Future<int> told_by(tess::ElementProxy<Node> node) {
  tess::Future<int> value;
  node.send<&Node::tell>(value.callback());
  return value;
}
}  // namespace

TEST_CASE("a future is moved, also once its result is there", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(3));
    std::vector<tess::Future<int>> all;
    for (int i = 0; i < 3; ++i) nodes[{i}].send<&Node::tell>(all.emplace_back().callback());
    co_await tess::epoch([&] { nodes.broadcast<&Node::large>(5); });
    std::vector<tess::Future<int>> moved;
    for (tess::Future<int>& one : all) moved.push_back(std::move(one));
    for (std::size_t i = 0; i + 1 < moved.size(); ++i) CHECK(co_await moved[i] % 5 == 0);
    CHECK(co_await std::move(moved.back()) % 5 == 0);
    CHECK(co_await told_by(nodes[{2}]) % 5 == 0);
  });
}

namespace {

/// Has a future as a member, and awaits it on several PEs.
class Traveller : public tess::Chare<Traveller> {
 public:
  void give(tess::Callback<int> target) { target(tess::my_pe().value); }
  tess::Task ask_itself(tess::Callback<int> target) {
    if (n_asked_++ > 0) news_ = tess::Future<int>();
    const auto own = news_.callback();
    using Place = std::tuple<tess::PeId, std::uint64_t>;
    CHECK(std::get<0>(tess::from_bytes<Place>(own.where())) == tess::my_pe());
    self().send<&Traveller::give>(own);
    const int pe = co_await news_;
    target(pe);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_asked_);
  }

 private:
  tess::Future<int> news_;
  int n_asked_ = 0;
};

tess::Task travel() {
  const auto travellers = tess::create<Traveller>(tess::range(1));
  for (const int to : {1, 0, 1, 2, 3}) {
    co_await tess::epoch([&] { travellers[{0}].migrate_to(tess::PeId{to}); });
    tess::Future<int> met;
    travellers[{0}].send<&Traveller::ask_itself>(met.callback());
    const int pe = co_await met;
    CHECK(pe == to);
  }
}

}  // namespace

TEST_CASE("a future that is a member has its result on the PE where it is used", "[api]") {
  over_seeds(&travel);
}

TEST_CASE("an entry method has any number of arguments, and overloads", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(4));
    tess::Future<double> sum;
    nodes[{2}].send<&Node::four>(1, "four", 0.5, std::vector<int>(3), sum.callback());
    CHECK(co_await sum == 8.5);
    co_await tess::epoch([&] {
      nodes[{0}].send<tess::overload<int>(&Node::set)>(12);
      nodes[{3}].send<tess::overload<std::string>(&Node::set)>("three");
    });
    tess::Future<int> first, last;
    nodes[{0}].send<&Node::tell>(first.callback());
    nodes[{3}].send<&Node::tell>(last.callback());
    CHECK(co_await first == 12);
    CHECK(co_await last == 5);
  });
}

TEST_CASE("a chare without a default constructor, alone and in a sparse array", "[api]") {
  over_seeds([]() -> tess::Task {
    const auto anna = tess::create_one<Named>(std::string("Anna"));
    const auto otto = tess::create_one_on<Named>(tess::PeId{3}, std::string("Otto"));
    const auto others = tess::create<Named>(tess::sparse);
    others[{7}].insert(std::string("Ida"));
    const std::string a = co_await anna.ask<&Named::name>();
    const std::string b = co_await otto.ask<&Named::name>();
    const std::string c = co_await others[{7}].ask<&Named::name>();
    CHECK(a + b + c == "AnnaOttoIda");
  });
}

TEST_CASE("an element is found on its PE only", "[api]") {
  REQUIRE(run_seeded(1, []() -> tess::Task {
            const auto nodes = tess::create<Node>(tess::range(8));
            CHECK(nodes.local({0}) != nullptr);  // the first block of indices is on PE 0
            CHECK(nodes.local({7}) == nullptr);
            CHECK(nodes.local({8}) == nullptr);
            CHECK(tess::my_pe() == tess::PeId{0});
            CHECK(tess::n_pes() == 4);
            CHECK(tess::machine().virtual_time());
            const tess::Time before = tess::now();
            co_await tess::epoch([&] { nodes.broadcast<&Node::large>(9); });
            CHECK(tess::now() > before);
            CHECK(nodes.local({0})->value() == 9);
          }) == 0);
}

TEST_CASE("an element that other code calls as an object moves and ends", "[api]") {
  REQUIRE(run_seeded(std::nullopt, [] { return call_two(false); }) == 0);
  over_seeds([] { return call_two(true); });
}

TEST_CASE("an element stays while its coroutine waits that other code called", "[api]") {
  over_seeds(&call_coroutine);
}

TEST_CASE("an element of one axis is named by an integer of any type, too", "[api]") {
  const tess::ArrayProxy<Node> nodes(tess::CollectionId{7});
  CHECK(nodes[3] == nodes[{3}]);
  CHECK(nodes[std::size_t{4}] == nodes[{4}]);
  CHECK(nodes[std::int64_t{-1}] == nodes[{-1}]);
  CHECK(nodes[0] == nodes[tess::Index1{}]);
}

TEST_CASE("indices of several axes are proxies' keys", "[api]") {
  CHECK(tess::index_text(tess::Index3{1, -2, 3}) == "[1,-2,3]");
  const tess::ElementProxy<Cube> a(tess::CollectionId{1}, {1, 2, 3}),
      b(tess::CollectionId{1}, {1, 2, 4});
  CHECK(a < b);
  CHECK(std::hash<tess::ElementProxy<Cube>>()(a) != std::hash<tess::ElementProxy<Cube>>()(b));
}
