// Homes that a class chooses by place(), and indices that are strings and structs.
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace {

int run_on_four(std::uint64_t seed, std::function<tess::Task()> main) {
  tess::SimulatedOptions options;
  options.n_pes = 4;
  options.seed = seed;
  options.cost = std::chrono::nanoseconds(100);
  options.migration_chance = 0;
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine(options);
  return tess::run(setup, std::move(main));
}

/// The PE on which each element was constructed, by its number.
using Places = std::vector<std::int32_t>;

/// Dense, from the last PE to the first, one by one.
class Dealt : public tess::Chare<Dealt> {
 public:
  static tess::PeId place(tess::Index1 index, std::int32_t n_pes) {
    return tess::PeId{n_pes - 1 - index.x % n_pes};
  }
  void report(tess::Callback<Places> target) {
    contribute(tess::in_order(tess::concatenate), Places{at_}, std::move(target));
  }

 private:
  std::int32_t at_ = tess::my_pe().value;
};

struct Page {
  std::string letters;
  std::int32_t page = 0;
  friend bool operator==(const Page&, const Page&) = default;
};

/// An entry for each element.
using Counts = std::vector<std::pair<std::string, int>>;

/// Counts its messages; one class for each type of index.
template <class Index>
class Tally : public tess::Chare<Tally<Index>, Index> {
 public:
  void count() { ++n_; }
  void report(tess::Callback<Counts> target) {
    this->contribute(tess::concatenate, Counts{{tess::index_text(this->index()), n_}},
                     std::move(target));
  }
  void serialize(auto& ar) { ar(n_); }

 private:
  int n_ = 0;
};

template <class Index>
class Demander : public tess::Group<Demander<Index>> {
 public:
  void send(tess::ArrayProxy<Tally<Index>> tallies, std::vector<Index> indices) {
    for (const Index& index : indices) {
      tallies[index].template send_or_create_here<&Tally<Index>::count>();
      tallies[index].migrate_to(tess::PeId{(tess::my_pe().value + 1) % tess::n_pes()});
    }
  }
};

template <class Index>
tess::Task count_from_everywhere(const std::vector<Index>& indices, Counts& found) {
  const auto tallies = tess::create<Tally<Index>>(tess::sparse);
  const auto demanders = tess::create<Demander<Index>>(tess::each_pe);
  co_await tess::epoch(
      [&] { demanders.template broadcast<&Demander<Index>::send>(tallies, indices); });
  found = co_await tallies.template reduce<&Tally<Index>::report>();
  std::ranges::sort(found);
}

template <class Index>
Counts counts(std::uint64_t seed, const std::vector<Index>& indices) {
  Counts found;
  REQUIRE(run_on_four(seed, [&] { return count_from_everywhere(indices, found); }) == 0);
  return found;
}

tess::Task deal(Places& found) {
  const auto dealt = tess::create<Dealt>(tess::range(10));
  found = co_await dealt.reduce<&Dealt::report>();
}

}  // namespace

TEST_CASE("elements of a dense array begin where their class places them", "[runtime][location]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Places found;
    REQUIRE(run_on_four(seed, [&] { return deal(found); }) == 0);
    CHECK(found == Places{3, 2, 1, 0, 3, 2, 1, 0, 3, 2});
  }
}

TEST_CASE("an element of a string or struct index exists once, whichever PEs demand it",
          "[runtime][location]") {
  const std::vector<std::string> words{"", "a", "a longer word than any buffer holds"};
  const std::vector<Page> pages{{"one", 1}, {"one", 2}, {"two", 1}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    CHECK(counts(seed, words) == Counts{{R"([""])", 4},
                                        {R"(["a longer word than any buffer holds"])", 4},
                                        {R"(["a"])", 4}});
    CHECK(counts(seed, pages) == Counts{{"[one,1]", 4}, {"[one,2]", 4}, {"[two,1]", 4}});
  }
}
