// A user's strategy without a run, as runtime/guide/write_a_strategy.md shows it.
// tests/samples/check.py compares.
#include "runtime/more/balance_offline.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <numeric>

namespace {

/// Consecutive bands of equal load, in the order of the first coordinate.
tess::balance::Assignment bands(const tess::balance::Snapshot& snapshot) {
  const auto& elements = snapshot.elements;
  double known = 0, n_known = 0;
  for (const tess::balance::Load& load : elements.load) {
    known += load.seconds_or(0);
    n_known += load.is_known() ? 1 : 0;
  }
  if (known == 0 || elements.position.empty()) return elements.pe;  // all stay
  const double mean = known / n_known;
  const double all = mean * static_cast<double>(elements.size());
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return elements.position[i]; });
  tess::balance::Assignment result(elements.size());
  double before = 0;
  for (const std::size_t i : order) {
    const double load = elements.load[i].seconds_or(mean);
    const double middle = (before + load / 2) / all;  // 0 … 1, but for rounding
    before += load;
    const auto pe = static_cast<std::size_t>(middle * static_cast<double>(snapshot.pes.size()));
    result[i] = tess::balance::pe_at(std::min(pe, snapshot.pes.size() - 1));
  }
  return result;
}

double imbalance_of_bands(const std::vector<std::string>& files) {
  const tess::balance::Strategy strategy = tess::balance::make_strategy(bands);
  double worst = 1;
  for (const tess::balance::Phase& phase : tess::balance::read_lb_datafiles(files)) {
    const auto result = tess::balance::measure(phase.snapshot, strategy(phase.snapshot));
    worst = std::max(worst, result.max_over_average);
  }
  return worst;
}

/// 16 elements in reverse order on the first of two PEs; element 3 does not migrate.
tess::balance::Snapshot line() {
  tess::balance::Snapshot s;
  s.pes.background = {0, 0};
  s.pes.speed = {1, 1};
  s.pes.memory_limit_bytes = {0, 0};
  for (std::size_t i = 0; i < 16; ++i) {
    s.elements.key.push_back({tess::CollectionId{1}, i});
    s.elements.pe.push_back(tess::PeId{0});
    s.elements.load.push_back(1);
    s.elements.migratable.push_back(i == 3 ? 0 : 1);
    s.elements.size_bytes.push_back(10);
    s.elements.memory_bytes.push_back(10);
    s.elements.position.push_back({16.0 - static_cast<double>(i), 0, 0});
  }
  return s;
}

}  // namespace

TEST_CASE("a user's strategy runs on saved snapshots with the rules of a run", "[balance]") {
  const tess::test::Scratch scratch;
  const std::string file =
      scratch.write("phases.json", tess::balance::write_lb_datafile({{0, line()}}));
  // Elements 0 … 7 belong to the second band; element 3 stays, so 9 of 16 are on PE 0.
  CHECK(imbalance_of_bands({file}) == Approx(9.0 / 8));
  const tess::balance::Assignment placed = tess::balance::make_strategy(bands)(line());
  CHECK(placed[3] == tess::PeId{0});
  CHECK(placed[4] == tess::PeId{1});
  CHECK(placed[12] == tess::PeId{0});
}

TEST_CASE("a user's strategy stands unknown loads and snapshots without positions", "[balance]") {
  tess::balance::Snapshot s = line();
  s.elements.load[0] = tess::balance::Load::unknown();  // the last one in the order
  CHECK(bands(s)[0] == tess::PeId{1});
  s.elements.load.assign(16, tess::balance::Load::unknown());
  CHECK(bands(s) == s.elements.pe);
  s = line();
  s.elements.position.clear();
  CHECK(bands(s) == s.elements.pe);
}
