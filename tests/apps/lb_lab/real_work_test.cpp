// The workloads of real work: what they compute against plainer ways to compute it, and that their
// load is one that moves.
#include "apps/lb_lab/collision/clusters.hpp"
#include "apps/lb_lab/particles/region.hpp"
#include "apps/lb_lab/particles/swarm.hpp"
#include "tests/apps/lb_lab/on_simulated.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <set>

using namespace lb_lab;

namespace {

Settings moving() {
  Settings s;
  s.per_pe = {8};
  s.n_iterations = 20;
  s.period = 4;
  s.grain = "10us";
  return s;
}

Problem problem(const char* workload, std::int32_t per_pe = 8) {
  Settings s = moving();
  s.per_pe = {per_pe};
  Problem p = problem_of(s, find_workload(workload), 4);
  p.domain = cut(p.domain, 4 * per_pe);
  return p;
}

/// Columns and rows that boxes touch.
std::set<std::pair<int, int>> touched(const Problem& p, std::int32_t iteration) {
  std::set<std::pair<int, int>> cells;
  const Clusters clusters(p);
  for (const tess::collide::Item& item : clusters.items(0, clusters.n_objects(), {}, iteration)) {
    REQUIRE(tess::collide::is_valid(item.box));
    REQUIRE((item.box.lo[0] >= 0 && item.box.hi[0] <= p.domain.width));
    REQUIRE((item.box.lo[1] >= 0 && item.box.hi[1] <= p.domain.height));
    REQUIRE((item.box.lo[2] >= 0 && item.box.hi[2] <= 1));
    cells.insert({static_cast<int>(item.box.lo[0]), static_cast<int>(item.box.lo[1])});
  }
  return cells;
}

/// The share of all particles that is in the fullest region.
double fullest(const Problem& p, const std::vector<Particle>& particles) {
  std::map<tess::Index2, int> n;
  for (const Particle& particle : particles) {
    const tess::Index2 at = region_of(p.domain, particle);
    REQUIRE((at.x >= 0 && at.x < p.domain.columns && at.y >= 0 && at.y < p.domain.rows));
    ++n[at];
  }
  const auto most = std::max_element(
      n.begin(), n.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return static_cast<double>(most->second) / static_cast<double>(particles.size());
}

}  // namespace

TEST_CASE("the answer of a collision has every pair that brute force finds, once", "[lb_lab]") {
  const Problem p = problem("collision");
  const Clusters clusters(p);
  std::uint64_t answer = 0, n_pairs = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    const std::vector<tess::collide::Item> items = clusters.items(0, clusters.n_objects(), {}, t);
    for (std::size_t i = 0; i < items.size(); ++i)
      for (std::size_t j = i + 1; j < items.size(); ++j)
        if (tess::collide::overlap(items[i].box, items[j].box, tess::collide::Touching::counts)) {
          answer += answer_of_pair(items[j].id.local, items[i].id.local, t);
          ++n_pairs;
        }
  }
  CHECK(answer == serial_answer(p));
  // What a simulated machine is charged adds up to the grain, about.
  const double seconds = static_cast<double>(n_pairs) * clusters.seconds_a_pair();
  CHECK(seconds == Approx(total_seconds(p)).epsilon(0.4));
}

TEST_CASE("the place of an object does not depend on its owner", "[lb_lab]") {
  const Clusters clusters(problem("collision"));
  const std::uint64_t n = clusters.n_objects();
  const std::vector<tess::collide::Item> all = clusters.items(0, n, {}, 3);
  REQUIRE(all.size() == n);
  std::vector<tess::collide::Item> parts;
  for (std::uint64_t k = 0; k < 7; ++k) {
    const std::vector<tess::collide::Item> part = clusters.items(k * n / 7, (k + 1) * n / 7, {}, 3);
    parts.insert(parts.end(), part.begin(), part.end());
  }
  REQUIRE(parts.size() == n);
  for (std::uint64_t i = 0; i < n; ++i) {
    CHECK(static_cast<std::uint64_t>(all[i].id.local) == i);
    CHECK((parts[i].box == all[i].box && parts[i].id == all[i].id));
  }
}

TEST_CASE("clusters drift: the voxels that they touch come and go", "[lb_lab]") {
  const Problem p = problem("collision");
  const auto before = touched(p, 0), after = touched(p, p.n_iterations / 2);
  std::vector<std::pair<int, int>> gone;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                      std::back_inserter(gone));
  CHECK(gone.size() >= before.size() / 4);
  CHECK(before.size() < static_cast<std::size_t>(p.domain.n_cells()));
}

TEST_CASE("the path of a particle does not depend on other particles", "[lb_lab]") {
  const Problem p = problem("particles");
  const Swarm swarm(p);
  std::uint64_t answer = 0;
  for (std::uint64_t i = swarm.size(); i-- > 0;) {
    std::vector<Particle> alone{swarm.first(i)};
    for (std::int32_t t = 0; t < p.n_iterations; ++t) swarm.advance(alone, t);
    answer += Swarm::answer(alone.front());
  }
  CHECK(answer == serial_answer(p));
}

TEST_CASE("particles bunch up, and the bunch travels", "[lb_lab]") {
  const Problem p = problem("particles");
  const Swarm swarm(p);
  std::vector<Particle> all;
  for (std::uint64_t i = 0; i < swarm.size(); ++i) all.push_back(swarm.first(i));
  const double before = fullest(p, all);
  double at_half = 0, at_end = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    swarm.advance(all, t);
    double x = 0;
    for (const Particle& particle : all) x += particle.x / static_cast<double>(all.size());
    (t < p.n_iterations / 2 ? at_half : at_end) = x / p.domain.width;
  }
  CHECK(fullest(p, all) > 2 * before);
  CHECK(std::abs(at_half - at_end) > 0.2);
}

TEST_CASE("real work is balanced, on PEs of unlike speed, too", "[lb_lab]") {
  Settings s = moving();
  s.workloads = {"collision", "particles"};
  s.strategies = {"greedy"};
  s.grain = "40us";
  for (const bool unlike : {false, true}) {
    if (unlike) s.speeds = {1, 1, 1, 0.5};
    const Sweep sweep = sweep_on("pes=4,cost=1us", s);
    CHECK(sweep.wrong == "");
    REQUIRE(sweep.rows.size() == 4);
    for (std::size_t i = 0; i < 4; i += 2) {
      INFO(sweep.rows[i].workload << ", unlike speeds: " << unlike);
      CHECK(sweep.rows[i + 1].gain > 0.1);
      CHECK(sweep.rows[i + 1].n_moves > 0);
      CHECK(sweep.rows[i + 1].imbalance_after < sweep.rows[i].imbalance_after);
    }
  }
}
