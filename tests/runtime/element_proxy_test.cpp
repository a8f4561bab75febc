// Proxies as values: compared, hashed, sent and kept, keys of containers, also after a journey as
// bytes; and the calls that go through them.
#include "runtime/element_proxy.hpp"

#include "runtime/more/interface.hpp"
#include "runtime/more/process_group.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace {

class Speaker {
 public:
  Speaker() = default;
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;
  virtual ~Speaker() = default;
  virtual void speak() = 0;
};
class Actor : public tess::Chare<Actor>, public Speaker {
 public:
  void speak() override {}
};
class Page : public tess::Chare<Page, std::string> {};
class Usher : public tess::Group<Usher> {};
struct Stage {
  int width = 0;
};

/// Two handles differ, and each is found again by what its bytes give.
template <class Handle>
void check_keys(const Handle& a, const Handle& b) {
  const auto copy_of = [](const Handle& handle) {
    return tess::from_bytes<Handle>(tess::to_bytes(handle));
  };
  CHECK(a != b);
  CHECK(copy_of(a) == a);
  CHECK(copy_of(b) == b);
  const std::unordered_set<Handle> both{a, b, copy_of(a), copy_of(b)};
  CHECK(both.size() == 2);
  CHECK(both.contains(copy_of(b)));
  CHECK_FALSE(both.contains(Handle()));
  CHECK(copy_of(Handle()) == Handle());
  std::unordered_map<Handle, int> numbers{{a, 1}, {b, 2}};
  CHECK(numbers[copy_of(a)] + 10 * numbers[copy_of(b)] == 21);
}

void use_as_keys() {
  const auto actors = tess::create<Actor>(tess::range(4)),
             others = tess::create<Actor>(tess::range(4));
  check_keys(actors, others);
  check_keys(actors[{1}], actors[{2}]);
  check_keys(actors[{1}], others[{1}]);
  const auto pages = tess::create<Page>(tess::sparse);
  check_keys(pages["left"], pages["right"]);
  check_keys(tess::create_section(actors, {{0}, {1}}), tess::create_section(actors, {{0}, {1}}));
  const auto ushers = tess::create<Usher>(tess::each_pe);
  check_keys(ushers, tess::create<Usher>(tess::each_pe));
  check_keys(ushers[tess::PeId{1}], ushers[tess::PeId{2}]);
  check_keys(tess::create<Actor>(tess::one), tess::create<Actor>(tess::one));
  using Speakers = tess::InterfaceArray<Speaker>;
  check_keys(Speakers(actors), Speakers(others));
  check_keys(Speakers(actors)[{1}], Speakers(actors)[{2}]);
  const auto stages = tess::create<Stage>(tess::each_process);
  check_keys(stages, tess::create<Stage>(tess::each_process));
  check_keys(stages[tess::ProcessId{0}], stages[tess::ProcessId{1}]);
  check_keys(actors[{1}].with(tess::Priority{1}), actors[{1}].with(tess::Priority{2}));
  check_keys(actors[{1}].with(tess::create_home), actors[{2}].with(tess::create_home));
  check_keys(ushers.with(tess::expedited), ushers.with(tess::Priority{0}));
  check_keys(tess::create_read_only(Stage{3}), tess::create_read_only(Stage{3}));
}

class Link : public tess::Chare<Link> {
 public:
  void follow(tess::ElementProxy<Link, tess::Index1> other) { next_ = other; }
  void pass(tess::Callback<int> target) {
    if (next_ == tess::ElementProxy<Link, tess::Index1>()) return target(index().x);
    next_.send<&Link::pass>(target);
  }
  void four(int a, std::string b, double c, std::vector<int> d, tess::Callback<double> target) {
    target(a + static_cast<double>(b.size()) + c + static_cast<double>(d.size()));
  }
  void set(int value) { value_ = value; }
  void set(std::string name) { value_ = static_cast<int>(name.size()); }
  void tell(tess::Callback<int> target) { target(value_); }

 private:
  tess::ElementProxy<Link, tess::Index1> next_;
  int value_ = 0;
};

class Greeter : public tess::Group<Greeter> {
 public:
  void hello(tess::MemberProxy<Greeter> from, tess::Callback<int> target) {
    contribute(tess::sum, from == group()[tess::PeId{0}] ? 1 : 0, target);
  }
};

class Cube : public tess::Chare<Cube, tess::Index3> {};

}  // namespace

TEST_CASE("handles of each kind are keys of unordered containers, also as copies from bytes",
          "[runtime][handles]") {
  CHECK(tests::run_threads(3, &use_as_keys).exit_code == 0);
}

TEST_CASE("an element's proxy is a value: empty, compared, hashed, sent, kept",
          "[runtime][proxy]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Link>(tess::range(5));
    for (int i = 0; i < 4; ++i) nodes[{i}].send<&Link::follow>(nodes[{i + 1}]);
    co_await tess::epoch([] {});
    const std::unordered_set<tess::ElementProxy<Link>> set{nodes[{1}], nodes[{2}], nodes[{1}]};
    CHECK(set.size() == 2);
    const std::map<tess::ElementProxy<Link>, int> map{{nodes[{1}], 1}, {nodes[{0}], 0}};
    CHECK(map.begin()->second == 0);
    CHECK(std::unordered_set<tess::ArrayProxy<Link>>{nodes, nodes}.size() == 1);
    co_await tess::epoch([&] {
      for (int i = 0; i < 4; ++i) nodes[{i}].send<&Link::follow>(nodes[{i + 1}]);
    });
    tess::Future<int> last;
    nodes[{0}].send<&Link::pass>(last.callback());
    CHECK(co_await last == 4);

    const auto members = tess::create<Greeter>(tess::each_pe);
    tess::MemberProxy<Greeter> from;
    CHECK(from != members[tess::PeId{1}]);
    from = members[tess::PeId{0}];
    const int n_greeted = co_await members.reduce<&Greeter::hello>(from);
    CHECK(n_greeted == tess::n_pes());
    CHECK(std::unordered_set<tess::MemberProxy<Greeter>>{from, members[tess::PeId{1}]}.size() == 2);
  });
}

TEST_CASE("an entry method has any number of arguments, and overloads", "[runtime][proxy]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Link>(tess::range(4));
    tess::Future<double> sum;
    nodes[{2}].send<&Link::four>(1, "four", 0.5, std::vector<int>(3), sum.callback());
    CHECK(co_await sum == 8.5);
    co_await tess::epoch([&] {
      nodes[{0}].send<tess::overload<int>(&Link::set)>(12);
      nodes[{3}].send<tess::overload<std::string>(&Link::set)>("three");
    });
    tess::Future<int> first, last;
    nodes[{0}].send<&Link::tell>(first.callback());
    nodes[{3}].send<&Link::tell>(last.callback());
    CHECK(co_await first == 12);
    CHECK(co_await last == 5);
  });
}

TEST_CASE("an element of one axis is named by an integer of any type, too", "[runtime][proxy]") {
  const tess::ArrayProxy<Link> nodes(tess::CollectionId{7});
  CHECK(nodes[3] == nodes[{3}]);
  CHECK(nodes[std::size_t{4}] == nodes[{4}]);
  CHECK(nodes[std::int64_t{-1}] == nodes[{-1}]);
  CHECK(nodes[0] == nodes[tess::Index1{}]);
}

TEST_CASE("indices of several axes are proxies' keys", "[runtime][proxy]") {
  CHECK(tess::index_text(tess::Index3{1, -2, 3}) == "[1,-2,3]");
  const tess::ElementProxy<Cube> a(tess::CollectionId{1}, {1, 2, 3}),
      b(tess::CollectionId{1}, {1, 2, 4});
  CHECK(a < b);
  CHECK(std::hash<tess::ElementProxy<Cube>>()(a) != std::hash<tess::ElementProxy<Cube>>()(b));
}
