// Scans over dense and sparse arrays and groups, several at once, while elements migrate, come and
// go. Each element compares its results with those of all elements of lower index.
#include "runtime/more/scan.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <numeric>
#include <string>

namespace {

/// What an element of this rank gives to a scan, in a form that no combination of others equals.
std::string word(int scan, std::int64_t rank) {
  return std::to_string(scan) + ":" + std::to_string(rank) + " ";
}
std::string words_before(int scan, std::int64_t end) {
  std::string all;
  for (std::int64_t rank = 0; rank < end; ++rank) all += word(scan, rank);
  return all;
}
std::int64_t number(int scan, std::int64_t rank) {
  return (scan + 1) * (rank * rank + 3);
}
std::int64_t sum_before(int scan, std::int64_t end) {
  std::int64_t sum = 0;
  for (std::int64_t rank = 0; rank < end; ++rank) sum += number(scan, rank);
  return sum;
}
double fraction(int scan, std::int64_t rank) {
  return 1.0 / static_cast<double>(3 + scan + 7 * rank);
}

/// Keeps the mean of what it has combined.
struct RunningMean {
  struct Part {
    double sum = 0;
    std::int64_t n = 0;
  };
  Part combine(Part a, const Part& b) const { return {a.sum + b.sum, a.n + b.n}; }
  double finish(Part all) const { return all.sum / static_cast<double>(all.n); }
};

class Tile : public tess::Chare<Tile, tess::Index2> {
 public:
  /// Several scans in flight, whose results come as messages: the element migrates meanwhile.
  void give_words(int n_scans) {
    for (int scan = 0; scan < n_scans; ++scan)
      contribute(tess::inclusive_scan(tess::concatenate), word(scan, rank()),
                 self().target<&Tile::take_words>());
  }
  void take_words(std::string words) {
    const int scan = std::stoi(words);
    n_right_ += words == words_before(scan, rank() + 1) ? 1 : 1000;
  }

  /// Several scans in flight in one coroutine.
  tess::Task give_numbers(int n_scans) {
    std::vector<tess::Future<std::int64_t>> sums(static_cast<std::size_t>(n_scans));
    std::vector<tess::Future<double>> means(static_cast<std::size_t>(n_scans));
    for (int scan = 0; scan < n_scans; ++scan) {
      const auto at = static_cast<std::size_t>(scan);
      contribute(tess::exclusive_scan(tess::sum, 7), number(scan, rank()), sums[at].callback());
      contribute(tess::inclusive_scan(RunningMean{}), RunningMean::Part{1.0 * scan, 1},
                 means[at].callback());
    }
    for (int scan = n_scans - 1; scan >= 0; --scan) {
      const auto at = static_cast<std::size_t>(scan);
      const std::int64_t sum = co_await sums[at];
      const double mean = co_await means[at];
      n_right_ += sum == 7 + sum_before(scan, rank()) && mean == scan ? 1 : 1000;
    }
  }

  /// The same bits wherever the elements are.
  tess::Task give_fractions(int scan) {
    tess::Future<double> sum;
    contribute(tess::inclusive_scan(tess::in_order(tess::sum)), fraction(scan, rank()),
               sum.callback());
    const double found = co_await sum;
    double expected = fraction(scan, 0);
    for (std::int64_t before = 1; before <= rank(); ++before) expected += fraction(scan, before);
    n_right_ += found == expected ? 1 : 1000;
  }

  void count(tess::Callback<std::int64_t> target) {
    contribute(tess::sum, std::int64_t{n_right_}, target);
  }

  void serialize(auto& ar) { ar(n_right_); }

 private:
  [[nodiscard]] std::int64_t rank() const { return tess::rank_in(array().range(), index()); }

  int n_right_ = 0;
};

tess::Task scan_tiles(std::int64_t& n_right) {
  const auto tiles = tess::create<Tile>(tess::range(3, 5));
  for (int round = 0; round < 2; ++round) {
    // The epoch of a contribution waits for the result.
    co_await tess::epoch([&] {
      tiles.broadcast<&Tile::give_words>(3);
      tiles.broadcast<&Tile::give_numbers>(2);
      tiles.broadcast<&Tile::give_fractions>(round);
      tiles.broadcast<&Tile::give_words>(1);
    });
  }
  n_right = co_await tiles.reduce<&Tile::count>();
}

/// Elements that come and go, with any ordered index.
class Entry : public tess::Chare<Entry, std::string> {
 public:
  void give(tess::Callback<std::vector<std::pair<std::string, std::string>>> target) {
    target_ = target;
    contribute(tess::inclusive_scan(tess::concatenate), index(), self().target<&Entry::take>());
  }
  void take(std::string names) { contribute(tess::gather, names, target_); }
  void serialize(auto& ar) { ar(target_); }

 private:
  tess::Callback<std::vector<std::pair<std::string, std::string>>> target_;
};

tess::Task scan_entries(std::vector<std::string>& found) {
  const auto entries = tess::create<Entry>(tess::sparse);
  std::vector<std::string> names{"pear", "fig", "apple", "plum", "cherry", "lime"};
  for (int round = 0; round < 3; ++round) {
    const std::string next = names[static_cast<std::size_t>(2 * round)];
    const std::string other = names[static_cast<std::size_t>(2 * round + 1)];
    co_await tess::epoch([&] {
      entries[next].insert();
      entries[other].insert_on(tess::PeId{tess::n_pes() - 1});
      if (round == 2) entries["fig"].destroy();
    });
    const auto pairs = co_await entries.reduce<&Entry::give>();
    for (const auto& [name, before] : pairs) found.push_back(before);
  }
}

/// Elements outside the range stand where their indices stand.
class Cell : public tess::Chare<Cell, tess::Index2> {
 public:
  void give() {
    contribute(tess::inclusive_scan(tess::concatenate),
               std::vector<std::pair<int, int>>{{index().x, index().y}},
               self().target<&Cell::take>());
  }
  void take(std::vector<std::pair<int, int>> before) {
    tess::test::expect(std::is_sorted(before.begin(), before.end()), "the order of ", index().x,
                       ",", index().y);
    tess::test::expect(before.back() == std::pair(index().x, index().y), "the last value");
    n_before_ = static_cast<int>(before.size());
  }
  void count(tess::Callback<int> target) { contribute(tess::sum, n_before_, target); }
  void serialize(auto& ar) { ar(n_before_); }

 private:
  int n_before_ = 0;
};

tess::Task scan_cells(int& n_all) {
  const auto cells = tess::create<Cell>(tess::range(3, 3));
  co_await tess::epoch([&] {
    for (const tess::Index2 outside : {tess::Index2{0, 7}, {-1, 2}, {1, -1}, {2, 3}, {1, 3}})
      cells[outside].insert_on(tess::PeId{tess::n_pes() / 2});
    cells[{1, 1}].destroy();
  });
  co_await tess::epoch([&] { cells.broadcast<&Cell::give>(); });
  n_all = co_await cells.reduce<&Cell::count>();
}

class Member : public tess::Group<Member> {
 public:
  void give(tess::Callback<std::vector<std::pair<tess::Index1, int>>> target) {
    target_ = target;
    contribute(tess::exclusive_scan(tess::sum, 0), pe().value + 1,
               group()[pe()].target<&Member::take>());
  }
  void take(int before) { contribute(tess::gather, before, target_); }

 private:
  tess::Callback<std::vector<std::pair<tess::Index1, int>>> target_;
};

tess::Task scan_group(std::vector<std::pair<tess::Index1, int>>& found) {
  const auto members = tess::create<Member>(tess::each_pe);
  found = co_await members.reduce<&Member::give>();
}

/// An index of a user's, in its own order, whose words are not those of a grid.
struct Shelf {
  std::int32_t x = 0;
  std::int16_t y = 0, z = 0;
  friend auto operator<=>(const Shelf&, const Shelf&) = default;
};
class Book : public tess::Chare<Book, Shelf> {
 public:
  tess::Task read(tess::Callback<std::vector<std::pair<Shelf, int>>> all) {
    tess::Future<int> sum;
    contribute(tess::inclusive_scan(tess::sum), static_cast<int>(index().z), sum.callback());
    const int before = co_await sum;
    contribute(tess::gather, before, all);
  }
};

tess::Task scan_books(std::vector<std::pair<Shelf, int>>& found) {
  const auto books = tess::create<Book>(tess::sparse);
  co_await tess::epoch([&] {
    books[Shelf{0, 0, 5}].insert_on(tess::PeId{0});
    books[Shelf{0, 1, 5}].insert_on(tess::PeId{0});
    books[Shelf{0, 0, 6}].insert_on(tess::PeId{1});
    books[Shelf{0, 1, 1}].insert_on(tess::PeId{1});
  });
  found = co_await books.reduce<&Book::read>();
}

/// One element never contributes, or the array ends in the middle: nothing of the scan is left.
class Leaf : public tess::Chare<Leaf> {
 public:
  void give(bool all) {
    if (all || index().x != 5)
      contribute(tess::inclusive_scan(tess::sum), index().x, self().target<&Leaf::take>());
  }
  void take(int /*sum*/) {}
  void nothing() {}
  /// The array ends meanwhile.
  tess::Task give_late() {
    co_await tess::sleep(std::chrono::microseconds(20));
    contribute(tess::inclusive_scan(tess::sum), index().x, self().target<&Leaf::take>());
    contribute(tess::sum, 1, array().target<&Leaf::take>());
  }
  void serialize(auto& /*ar*/) {}
};

tess::Task contribute_after_the_end(bool& over) {
  const auto leaves = tess::create<Leaf>(tess::range(6));
  co_await tess::epoch([&] { leaves.broadcast<&Leaf::nothing>(); });
  co_await tess::epoch([&] {
    for (int x = 0; x < 6; x += 2) leaves[{x}].send<&Leaf::give_late>();
    leaves.destroy();
  });
  over = true;
}

tess::Task end_in_a_scan(bool all, bool& over) {
  const auto leaves = tess::create<Leaf>(tess::range(9));
  co_await tess::epoch([&] {
    leaves.broadcast<&Leaf::give>(all);
    leaves[{5}].send<&Leaf::give>(false);
    tess::after(std::chrono::microseconds(3), [leaves] { leaves.destroy(); });
  });
  over = true;
}

template <class Main>
void run_on_threads(Main main) {
  tess::Setup setup{tess::make_threads_machine(3), {}};
  REQUIRE(tess::run(setup, std::move(main)) == 0);
}

constexpr std::int64_t n_right_of_tiles = 15 * 2 * (3 + 2 + 1 + 1);
const std::vector<std::string> names_before_entries{
    "fig",   "figpear",                                             //
    "apple", "applefig",    "applefigpear",    "applefigpearplum",  //
    "apple", "applecherry", "applecherrylime", "applecherrylimepear", "applecherrylimepearplum"};
constexpr int n_before_cells = 13 * 14 / 2;

}  // namespace

TEST_CASE("each element of a scan gets the values of lower indices, several scans in flight",
          "[runtime][scan]") {
  tess::test::for_seeds(0, 150, [](std::uint64_t seed) {
    std::int64_t n_right = 0;
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 6), .seed = seed};
    machine.run([&]() -> tess::Task { return scan_tiles(n_right); }).require_success();
    tess::test::expect(n_right == n_right_of_tiles, "of ", n_right_of_tiles, " results ", n_right);
  });
}

TEST_CASE("a scan of a sparse array is in the order of its indices", "[runtime][scan]") {
  tess::test::for_seeds(0, 100, [](std::uint64_t seed) {
    std::vector<std::string> found;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> tess::Task { return scan_entries(found); }).require_success();
    tess::test::expect(found == names_before_entries, "the names before each");
  });
}

TEST_CASE("elements outside the range stand in a scan where their indices stand",
          "[runtime][scan]") {
  tess::test::for_seeds(0, 100, [](std::uint64_t seed) {
    int n_all = 0;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> tess::Task { return scan_cells(n_all); }).require_success();
    tess::test::expect(n_all == n_before_cells, "values before: ", n_all);
  });
}

TEST_CASE("a scan is in the order of a user's index", "[runtime][scan]") {
  std::vector<std::pair<Shelf, int>> found;
  const tess::test::Machine machine{.pes = 2, .seed = 1};
  machine.run([&]() -> tess::Task { return scan_books(found); }).require_success();
  CHECK(found == std::vector<std::pair<Shelf, int>>{
                     {{0, 0, 5}, 5}, {{0, 0, 6}, 11}, {{0, 1, 1}, 12}, {{0, 1, 5}, 17}});
}

TEST_CASE("a scan of a group is in the order of PEs", "[runtime][scan]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<std::pair<tess::Index1, int>> found;
    const tess::test::Machine machine{.pes = 5, .seed = seed};
    machine.run([&]() -> tess::Task { return scan_group(found); }).require_success();
    CHECK(found == std::vector<std::pair<tess::Index1, int>>{
                       {{0}, 0}, {{1}, 1}, {{2}, 3}, {{3}, 6}, {{4}, 10}});
  }
}

TEST_CASE("an array that ends in the middle of a scan leaves no epoch open", "[runtime][scan]") {
  for (const bool all : {false, true}) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      INFO("seed " << seed);
      bool over = false;
      const tess::test::Machine machine{.pes = 4, .seed = seed};
      const auto result = machine.run([&]() -> tess::Task { return end_in_a_scan(all, over); });
      CHECK(result.exit_code == 0);
      CHECK(over);
    }
  }
}

TEST_CASE("a contribution to an array that has ended leaves no epoch open", "[runtime][scan]") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    bool over = false;
    const tess::test::Machine machine{.pes = 3, .seed = seed};
    const auto result = machine.run([&]() -> tess::Task { return contribute_after_the_end(over); });
    CHECK(result.exit_code == 0);
    CHECK(over);
  }
}

TEST_CASE("scans are right on the machine of threads", "[runtime][scan][threads]") {
  std::int64_t n_right = 0;
  run_on_threads([&]() -> tess::Task { return scan_tiles(n_right); });
  CHECK(n_right == n_right_of_tiles);
  std::vector<std::string> found;
  run_on_threads([&]() -> tess::Task { return scan_entries(found); });
  CHECK(found == names_before_entries);
}
