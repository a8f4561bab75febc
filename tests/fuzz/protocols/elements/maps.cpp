// Arrays whose elements a map places, while they migrate. Between rounds elements are inserted, are
// created on demand outside of the range, end, and are created again. The oracle: initial elements
// begin on the PE that the map gives, and the gathered totals of each round are those of a serial
// program.
#include "runtime/more/index_map.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <map>
#include <utility>

namespace tess::fuzz {
namespace {

constexpr std::int32_t n_columns = 4;

/// A map with state: it goes to all PEs with the array.
struct BySeed {
  std::uint64_t seed = 0;
  PeId operator()(Index2 at, std::int32_t n_pes) const {
    const auto key = static_cast<std::uint64_t>(at.x * 1000 + at.y);
    return PeId{static_cast<std::int32_t>(mix(seed ^ key) % static_cast<std::uint64_t>(n_pes))};
  }
};
/// Another, which is given the range.
PeId by_row(Index2 at, const Range& range, std::int32_t n_pes) {
  const std::int64_t rank = rank_in(range, at);
  return PeId{rank < 0 ? n_pes - 1 : static_cast<std::int32_t>(rank) / n_columns % n_pes};
}

struct MapCase {
  std::uint64_t seed = 0;
  double move_chance = 0;
  std::int32_t rows = 0;
  bool by_seed = false;

  [[nodiscard]] PeId place(Index2 at) const {
    return by_seed ? BySeed{seed}(at, tess::n_pes())
                   : by_row(at, range(rows, n_columns), tess::n_pes());
  }
};
const MapCase* map_case = nullptr;

/// By index, what each element gives in this round: a serial program and the elements draw alike.
struct Gift {
  Index2 to;
  std::int64_t value = 0;
};
Gift gift(std::int32_t round, Index2 from, const std::vector<Index2>& all) {
  const auto key = static_cast<std::uint64_t>((round * 100 + from.x) * 100 + from.y);
  Random random(mix(map_case->seed ^ mix(key)));
  return {all[random.below(all.size())], static_cast<std::int64_t>(random.below(1000))};
}

/// Says that an element is an initial one.
struct Initial {};

struct Round {
  std::int32_t number = 0;
  std::vector<Index2> all;  // that exist
};
using Totals = std::vector<std::pair<Index2, std::int64_t>>;

class MappedElement : public Chare<MappedElement, Index2> {
 public:
  MappedElement() = default;  // on demand, and where one arrives
  explicit MappedElement(Initial /*none*/) { begins_on(map_case->place(index())); }
  explicit MappedElement(PeId place) { begins_on(place); }
  void give(const Round& round) {
    Random random(mix(map_case->seed ^ static_cast<std::uint64_t>(index().x * 77 + index().y)));
    const Gift mine = gift(round.number, index(), round.all);
    array()[mine.to].send<&MappedElement::take>(mine.value);
    if (random.chance(map_case->move_chance)) migrate_to(any_pe(random));
  }
  void take(std::int64_t value) { total_ += value; }
  void report(Callback<Totals> target) { contribute(gather, total_, target); }

  void serialize(auto& ar) { ar(total_); }

 private:
  void begins_on(PeId place) const {
    expect(tess::my_pe() == place, "element ", index().x, ",", index().y, " begins on ",
           tess::my_pe(), ", not on ", place);
  }

  std::int64_t total_ = 0;
};

/// Elements that come and go, here and in the array.
void change(const ArrayProxy<MappedElement>& elements, Random& random,
            std::map<Index2, std::int64_t>& totals) {
  for (std::uint64_t n = random.below(4); n > 0; --n) {
    const Index2 at{static_cast<std::int32_t>(random.below(9)),
                    static_cast<std::int32_t>(random.below(9))};
    if (totals.contains(at)) continue;
    const auto value = static_cast<std::int64_t>(random.below(100));
    if (random.chance(0.5)) {
      const PeId place = random.chance(0.5) ? map_case->place(at) : any_pe(random);
      totals[at] = 0;
      elements[at].insert_on(place, place);
    } else {
      totals[at] = value;
      elements[at].send_or_create_home<&MappedElement::take>(value);
    }
  }
}

Task run_rounds(std::int32_t n_rounds) {
  Random random(mix(map_case->seed + 1));
  const Range whole = range(map_case->rows, n_columns);
  std::map<Index2, std::int64_t> totals;
  for (std::int32_t x = 0; x < map_case->rows; ++x)
    for (std::int32_t y = 0; y < n_columns; ++y) totals[{x, y}] = 0;
  const auto elements =
      map_case->by_seed
          ? tess::create<MappedElement>(mapped(whole, BySeed{map_case->seed}), Initial{})
          : tess::create<MappedElement>(mapped<&by_row>(whole), Initial{});
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    std::vector<Index2> all;
    for (const auto& [at, total] : totals) all.push_back(at);
    for (const Index2 at : all) {
      const Gift its = gift(round, at, all);
      totals[its.to] += its.value;
    }
    co_await epoch([&] { elements.broadcast<&MappedElement::give>(Round{round, all}); });
    const Totals given = co_await elements.reduce<&MappedElement::report>();
    expect(given == Totals(totals.begin(), totals.end()), "round ", round, ": ", given.size(),
           " totals, not those of ", totals.size(), " elements");
    co_await epoch([&] { change(elements, random, totals); });
    if (totals.size() > 1 && random.chance(0.5)) {
      const auto last = std::prev(totals.end())->first;
      totals.erase(last);
      co_await epoch([&] { elements[last].destroy(); });
    }
  }
}

}  // namespace

void maps(Case& test) {
  const std::uint64_t seed = test.random();
  const MapCase here{seed, 0.3 * test.draw(0, 2), test.draw(1, 6), test.draw(0, 1) == 1};
  map_case = &here;
  const std::int32_t n_rounds = test.draw(2, 8);
  test.run_clean([&] { return run_rounds(n_rounds); });
}

}  // namespace tess::fuzz
