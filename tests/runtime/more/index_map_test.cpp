// Arrays whose elements a map places: where they are created, what is created on demand, and
// restarts on another number of PEs. (misuse.cpp has a map that names a PE that does not exist.)
#include "runtime/more/index_map.hpp"

#include "runtime/checkpoint.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <string>

namespace {

using Places = std::vector<std::pair<tess::Index2, int>>;

/// A map with members: the rows of a checkerboard's colours.
struct ByColour {
  int first = 0;
  std::vector<int> pe_of_colour;
  tess::PeId operator()(const tess::Index2& at, std::int32_t n_pes) const {
    return tess::PeId{pe_of_colour[static_cast<std::size_t>((at.x + at.y + first) & 1)] % n_pes};
  }
};
struct Last {
  tess::PeId operator()(const std::string& /*name*/, std::int32_t n_pes) const {
    return tess::PeId{n_pes - 1};
  }
};
tess::PeId by_row(const tess::Index2& at, const tess::Range& range, std::int32_t n_pes) {
  return tess::PeId{at.x * n_pes / range.extent[0]};
}
class Field : public tess::Chare<Field, tess::Index2> {
 public:
  Field() = default;
  explicit Field(int value) : value_(value), made_on_(tess::my_pe().value) {}
  void where(tess::Callback<Places> target) { contribute(tess::gather, made_on_, target); }
  void add(int more) { value_ += more; }
  void total(tess::Callback<int> target) { contribute(tess::sum, value_, target); }
  [[nodiscard]] int now_on() { return tess::my_pe().value; }
  void serialize(auto& ar) { ar(value_, made_on_); }

 private:
  int value_ = 0;
  int made_on_ = tess::my_pe().value;
};

class Name : public tess::Chare<Name, std::string> {
 public:
  void note() { made_on_ = tess::my_pe().value; }
  [[nodiscard]] int made_on() { return made_on_; }
  void serialize(auto& ar) { ar(made_on_); }

 private:
  int made_on_ = tess::my_pe().value;
};

class Dot : public tess::Chare<Dot> {
 public:
  void note() {}
  [[nodiscard]] int now_on() { return tess::my_pe().value; }
  void serialize(auto& /*ar*/) {}
};

struct Placed {
  Places colours, rows, blocks, turns;
  int total = 0;
};

tess::Task place(Placed& found) {
  const ByColour by_colour{1, {2, 5}};
  const auto colours = tess::create<Field>(tess::mapped(tess::range(4, 4), by_colour), 3);
  const auto rows = tess::create<Field>(tess::mapped<&by_row>(tess::range(4, 4)), 0);
  const auto blocks = tess::create<Field>(tess::mapped(tess::range(4, 4), tess::block), 0);
  const auto turns = tess::create<Field>(tess::mapped(tess::range(4, 4), tess::round_robin), 0);
  const auto ask = [](const tess::ArrayProxy<Field>& fields, tess::Future<Places>& places) {
    fields.broadcast<&Field::where>(places.callback());
  };
  tess::Future<Places> by_colours, by_rows, by_blocks, in_turns;
  ask(colours, by_colours);
  ask(rows, by_rows);
  ask(blocks, by_blocks);
  ask(turns, in_turns);
  found.colours = co_await by_colours;
  found.rows = co_await by_rows;
  found.blocks = co_await by_blocks;
  found.turns = co_await in_turns;
  // Messages find the elements wherever they have migrated, by the homes that the map gives.
  co_await tess::epoch([&] {
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y) colours[{x, y}].send<&Field::add>(x * y);
  });
  found.total = co_await colours.reduce<&Field::total>();
}

void check_placed(const Placed& found, int n_pes) {
  tess::test::expect(found.colours.size() == 16 && found.rows.size() == 16 &&
                         found.blocks.size() == 16 && found.turns.size() == 16,
                     "sizes");
  const ByColour by_colour{1, {2, 5}};
  for (int rank = 0; rank < 16; ++rank) {
    const auto at = static_cast<std::size_t>(rank);
    const tess::Index2 index{rank / 4, rank % 4};
    tess::test::expect(found.colours[at] == std::pair(index, by_colour(index, n_pes).value),
                       "by colour ", rank);
    tess::test::expect(found.rows[at] == std::pair(index, index.x * n_pes / 4), "by row ", rank);
    tess::test::expect(found.blocks[at] == std::pair(index, rank * n_pes / 16), "block ", rank);
    tess::test::expect(found.turns[at] == std::pair(index, rank % n_pes), "round robin ", rank);
  }
  tess::test::expect(found.total == 16 * 3 + 36, "total ", found.total);
}

tess::Task create_on_demand(int& made_on, int& far_on, std::vector<int>& dots_on) {
  const auto names = tess::create<Name>(tess::mapped(tess::sparse, Last{}));
  names["anna"].send_or_create_home<&Name::note>();
  made_on = co_await names["anna"].ask<&Name::made_on>();
  const auto fields = tess::create<Field>(tess::mapped(tess::range(2, 2), ByColour{0, {1, 2}}), 0);
  fields[{7, 8}].send_or_create_home<&Field::add>(1);
  far_on = co_await fields[{7, 8}].ask<&Field::now_on>();
  const auto dots = tess::create<Dot>(tess::mapped(tess::sparse, tess::round_robin));
  for (const int x : {-4, -3, 0, 7}) {
    dots[{x}].send_or_create_home<&Dot::note>();
    const int pe = co_await dots[{x}].ask<&Dot::now_on>();
    dots_on.push_back(pe);
  }
}

struct SavedFields {
  tess::ArrayProxy<Field> fields;
};
tess::Task save(std::string folder) {
  SavedFields state;
  state.fields = tess::create<Field>(tess::mapped(tess::range(3, 3), ByColour{1, {0, 2}}), 4);
  co_await tess::epoch([&] { state.fields[{1, 2}].migrate_to(tess::PeId{1}); });
  co_await tess::checkpoint(folder, state);
}
tess::Task load(std::string folder, std::vector<int>& now_on) {
  const SavedFields state = co_await tess::restart<SavedFields>(folder);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y) {
      const int pe = co_await state.fields[{x, y}].ask<&Field::now_on>();
      now_on.push_back(pe);
    }
  state.fields[{5, 5}].send_or_create_home<&Field::add>(1);
  const int pe = co_await state.fields[{5, 5}].ask<&Field::now_on>();
  now_on.push_back(pe);
}

}  // namespace

TEST_CASE("a map places the initial elements, and messages find them", "[runtime][map]") {
  tess::test::for_seeds(0, 100, [](std::uint64_t seed) {
    Placed found;
    const int n_pes = 1 + static_cast<int>(seed % 5);
    const tess::test::Machine machine{.pes = n_pes, .seed = seed};
    machine.run([&]() -> tess::Task { return place(found); }).require_success();
    check_placed(found, n_pes);
  });
}

TEST_CASE("a map places the initial elements on the machine of threads",
          "[runtime][map][threads]") {
  Placed found;
  tess::Setup setup{tess::make_threads_machine(3), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return place(found); }) == 0);
  check_placed(found, 3);
}

TEST_CASE("what is created on demand is created where the map says", "[runtime][map]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    INFO("seed " << seed);
    int made_on = -1, far_on = -1;
    std::vector<int> dots_on;
    const tess::test::Machine machine{.pes = 3, .seed = seed, .migration = 0.0};
    machine.run([&]() -> tess::Task { return create_on_demand(made_on, far_on, dots_on); })
        .require_success();
    CHECK(made_on == 2);
    CHECK(far_on == 2);
    CHECK(dots_on == std::vector<int>{2, 0, 0, 1});
  }
}

TEST_CASE("a checkpoint keeps the map, which places the elements anew after a restart",
          "[runtime][map][checkpoint]") {
  for (const int n_pes : {1, 2, 4}) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    const tess::test::Machine first{.pes = 3, .seed = 7, .migration = 0.0};
    first.run([&]() -> tess::Task { return save(folder); }).require_success();
    std::vector<int> now_on;
    const tess::test::Machine second{.pes = n_pes, .seed = 8, .migration = 0.0};
    second.run([&]() -> tess::Task { return load(folder, now_on); }).require_success();
    const int even = 2 % n_pes;
    CHECK(now_on == std::vector<int>{even, 0, even, 0, even, 0, even, 0, even, even});
  }
}
