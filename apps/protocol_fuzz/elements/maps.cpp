// Arrays whose elements a map places, while they migrate. Between rounds elements are inserted, are
// created on demand outside of the range, end, and are created again. The oracle: initial elements
// begin on the PE that the map gives, and the gathered totals of each round are those of a serial
// program.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/index_map.hpp"

#include <map>
#include <utility>

namespace tess::fuzz {
namespace {

constexpr std::int32_t n_columns = 4;

/// A map with state: it goes to all PEs with the array.
struct BySeed {
  std::uint64_t seed = 0;
  PeId operator()(Index2 plot, std::int32_t n_pes) const {
    const auto key = static_cast<std::uint64_t>(plot.x * 1000 + plot.y);
    return PeId{static_cast<std::int32_t>(mix(seed ^ key) % static_cast<std::uint64_t>(n_pes))};
  }
};
/// Another, which is given the range.
PeId by_row(Index2 plot, const Range& range, std::int32_t n_pes) {
  const std::int64_t rank = rank_in(range, plot);
  return PeId{rank < 0 ? n_pes - 1 : static_cast<std::int32_t>(rank) / n_columns % n_pes};
}

struct Plan {
  Trial& trial;
  std::uint64_t seed = 0;
  double move_chance = 0;
  std::int32_t rows = 0;
  bool by_seed = false;

  [[nodiscard]] PeId place(Index2 plot) const {
    return by_seed ? BySeed{seed}(plot, tess::n_pes())
                   : by_row(plot, range(rows, n_columns), tess::n_pes());
  }
};
const Plan* plan = nullptr;

/// By index, what each element gives in this round: a serial program and the elements draw alike.
struct Gift {
  Index2 to;
  std::int64_t value = 0;
};
Gift gift(std::int32_t round, Index2 from, const std::vector<Index2>& all) {
  const auto key = static_cast<std::uint64_t>((round * 100 + from.x) * 100 + from.y);
  Random random(mix(plan->seed ^ mix(key)));
  return {all[random.below(all.size())], static_cast<std::int64_t>(random.below(1000))};
}

/// Says that an element is an initial one.
struct Initial {};

struct Round {
  std::int32_t number = 0;
  std::vector<Index2> all;  // that exist
};
using Totals = std::vector<std::pair<Index2, std::int64_t>>;

class Plot : public Chare<Plot, Index2> {
 public:
  Plot() = default;  // on demand, and where one arrives
  explicit Plot(Initial /*none*/) { begins_on(plan->place(index())); }
  explicit Plot(PeId place) { begins_on(place); }
  void give(const Round& round) {
    Random random(mix(plan->seed ^ static_cast<std::uint64_t>(index().x * 77 + index().y)));
    const Gift mine = gift(round.number, index(), round.all);
    array()[mine.to].send<&Plot::take>(mine.value);
    if (random.chance(plan->move_chance)) migrate_to(any_pe(random));
  }
  void take(std::int64_t value) { total_ += value; }
  void report(Callback<Totals> target) { contribute(gather, total_, target); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(total_);
  }

 private:
  void begins_on(PeId place) const {
    plan->trial.expect(tess::my_pe() == place, "element ", index().x, ",", index().y, " begins on ",
                       tess::my_pe(), ", not on ", place);
  }

  std::int64_t total_ = 0;
};

/// Elements that come and go, here and in the array.
void change(const ArrayProxy<Plot>& plots, Random& random, std::map<Index2, std::int64_t>& totals) {
  for (std::uint64_t n = random.below(4); n > 0; --n) {
    const Index2 plot{static_cast<std::int32_t>(random.below(9)),
                      static_cast<std::int32_t>(random.below(9))};
    if (totals.contains(plot)) continue;
    const auto value = static_cast<std::int64_t>(random.below(100));
    if (random.chance(0.5)) {
      const PeId place = random.chance(0.5) ? plan->place(plot) : any_pe(random);
      totals[plot] = 0;
      plots[plot].insert_on(place, place);
    } else {
      totals[plot] = value;
      plots[plot].send_or_create_home<&Plot::take>(value);
    }
  }
}

Task till(std::int32_t n_rounds) {
  Random random(mix(plan->seed + 1));
  const Range field = range(plan->rows, n_columns);
  std::map<Index2, std::int64_t> totals;
  for (std::int32_t x = 0; x < plan->rows; ++x)
    for (std::int32_t y = 0; y < n_columns; ++y) totals[{x, y}] = 0;
  const auto plots = plan->by_seed
                         ? tess::create<Plot>(mapped(field, BySeed{plan->seed}), Initial{})
                         : tess::create<Plot>(mapped<&by_row>(field), Initial{});
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    std::vector<Index2> all;
    for (const auto& [plot, total] : totals) all.push_back(plot);
    for (const Index2 plot : all) {
      const Gift its = gift(round, plot, all);
      totals[its.to] += its.value;
    }
    co_await epoch([&] { plots.broadcast<&Plot::give>(Round{round, all}); });
    const Totals given = co_await plots.reduce<&Plot::report>();
    plan->trial.expect(given == Totals(totals.begin(), totals.end()), "round ", round, ": ",
                       given.size(), " totals, not those of ", totals.size(), " elements");
    co_await epoch([&] { change(plots, random, totals); });
    if (totals.size() > 1 && random.chance(0.5)) {
      const auto last = std::prev(totals.end())->first;
      totals.erase(last);
      co_await epoch([&] { plots[last].destroy(); });
    }
  }
}

}  // namespace

void maps(Trial& trial) {
  const std::uint64_t seed = trial.random()();
  const Plan here{trial, seed, 0.3 * trial.draw(0, 2), trial.draw(1, 6), trial.draw(0, 1) == 1};
  plan = &here;
  const std::int32_t n_rounds = trial.draw(2, 8);
  trial.run_clean([&] { return till(n_rounds); });
}

}  // namespace tess::fuzz
