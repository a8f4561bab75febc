// The graphs of task_bench against brute force, its inputs, kernels and search: no messages.
#include "apps/task_bench/graph.hpp"
#include "apps/task_bench/inputs.hpp"
#include "apps/task_bench/metg.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

namespace {

using namespace task_bench;

Graph graph_of(const std::string& type, std::int32_t width, std::int64_t steps = 20) {
  Graph g;
  g.type = parse_type(type);
  g.width = width;
  g.steps = steps;
  if (has_period(g.type)) g.period = 3;
  return g;
}

/// Whether point `to` needs the output of point `from`, told from the paper's definition by itself.
bool depends(const Graph& g, std::int32_t set, std::int32_t to, std::int32_t from) {
  const std::int32_t w = g.width, ahead = ((from - to) % w + w) % w;
  switch (g.type) {
    case Type::trivial:
      return false;
    case Type::no_comm:
      return from == to;
    case Type::stencil_1d:
      return std::abs(from - to) <= 1;
    case Type::stencil_1d_periodic:
      return ahead <= 1 || ahead == w - 1;
    case Type::dom:
      return from == to || from == to - 1;
    case Type::tree:
      return from == to / 2;
    case Type::fft:
      return from == to || std::abs(from - to) == (1 << set);
    case Type::all_to_all:
      return true;
    case Type::nearest: {
      // radix points: as many below as above, one more below where the radix is even
      const std::int32_t below = g.radix / 2;
      return from >= to - below && from < to - below + g.radix;
    }
    case Type::spread: {
      for (std::int32_t i = 0; i < g.radix; ++i)
        if (ahead == (i * w / g.radix + (i > 0 ? set : 0)) % w) return true;
      return false;
    }
    case Type::random_nearest:
      return false;  // a test of its own
  }
  return false;
}

const std::vector<std::int32_t> widths{1, 2, 3, 5, 8, 16, 17};

}  // namespace

TEST_CASE("dependences are those of the definition, for each type, width and radix",
          "[task_bench]") {
  for (const std::string& type : type_names()) {
    if (type == "random_nearest") continue;
    for (const std::int32_t width : widths)
      for (const std::int32_t radix : {0, 1, 2, 3, 4, 5}) {
        Graph g = graph_of(type, width);
        g.radix = radix;
        if (radix == 0 && g.type == Type::spread) continue;
        for (std::int32_t set = 0; set < n_sets(g); ++set)
          for (std::int32_t p = 0; p < width; ++p) {
            std::vector<std::int32_t> expected;
            for (std::int32_t q = 0; q < width; ++q)
              if (depends(g, set, p, q)) expected.push_back(q);
            INFO(type << ", width " << width << ", radix " << radix << ", set " << set << ", point "
                      << p);
            REQUIRE(dependences(g, set, p) == expected);
          }
      }
  }
}

TEST_CASE("dependents are the inverse of dependences, for each type", "[task_bench]") {
  for (const std::string& type : type_names())
    for (const std::int32_t width : widths)
      for (const std::int32_t radix : {0, 1, 2, 3, 4, 5, 9}) {
        Graph g = graph_of(type, width);
        g.radix = radix;
        if (radix == 0 && g.type == Type::spread) continue;
        for (std::int32_t set = 0; set < n_sets(g); ++set) {
          std::set<std::pair<std::int32_t, std::int32_t>> forward, reverse;
          for (std::int32_t p = 0; p < width; ++p) {
            for (const std::int32_t q : dependences(g, set, p))
              REQUIRE(forward.emplace(q, p).second);
            for (const std::int32_t q : dependents(g, set, p))
              REQUIRE(reverse.emplace(p, q).second);
          }
          INFO(type << ", width " << width << ", radix " << radix << ", set " << set);
          REQUIRE(forward == reverse);
        }
      }
}

TEST_CASE("random_nearest has its fraction of the nearest edges, and always a point's own",
          "[task_bench]") {
  Graph g = graph_of("random_nearest", 2000);
  g.radix = 21;
  g.fraction = 0.3;
  std::size_t n = 0;
  for (std::int32_t set = 0; set < 3; ++set)
    for (std::int32_t p = 10; p < 1990; ++p) {
      const auto from = dependences(g, set, p);
      REQUIRE(std::find(from.begin(), from.end(), p) != from.end());
      REQUIRE(from.front() >= p - 10);
      REQUIRE(from.back() <= p + 10);
      n += from.size() - 1;
    }
  CHECK(static_cast<double>(n) / (3 * 1980 * 20) == Approx(0.3).margin(0.01));
  CHECK(dependences(g, 0, 100) != dependences(g, 1, 100));
  g.fraction = 1;
  CHECK(dependences(g, 0, 100).size() == 21);
}

TEST_CASE("dom is a band, tree doubles, the others have all points at every step", "[task_bench]") {
  Graph dom = graph_of("dom", 4, 10);
  std::vector<std::pair<std::int32_t, std::int32_t>> band;
  for (std::int64_t step = 0; step < 10; ++step)
    band.emplace_back(points_at(dom, step).first, points_at(dom, step).end);
  CHECK(band ==
        std::vector<std::pair<std::int32_t, std::int32_t>>{
            {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 4}, {0, 4}, {0, 4}, {1, 4}, {2, 4}, {3, 4}});
  Graph tree = graph_of("tree", 5, 40);
  CHECK(points_at(tree, 0).end == 1);
  CHECK(points_at(tree, 2).end == 4);
  CHECK(points_at(tree, 3).end == 5);
  CHECK(points_at(tree, 39).end == 5);
  CHECK(points_at(graph_of("fft", 7), 0).end == 7);
  CHECK(points_at(dom, -1).end == 0);
}

TEST_CASE("the totals of a graph are those of its tasks one by one", "[task_bench]") {
  for (const std::string& type : type_names())
    for (const std::int32_t width : widths) {
      Graph g = graph_of(type, width, 13);
      g.kernel.iterations = 5;
      Totals expected;
      for (std::int64_t step = 0; step < g.steps; ++step)
        for (std::int32_t p = points_at(g, step).first; p < points_at(g, step).end; ++p) {
          ++expected.n_tasks;
          expected.n_iterations += 5;
          for (const std::int32_t q : dependences(g, set_at(g, step), p))
            expected.n_dependences += points_at(g, step - 1).contains(q) ? 1U : 0U;
        }
      INFO(type << ", width " << width);
      CHECK(totals(g).n_tasks == expected.n_tasks);
      CHECK(totals(g).n_dependences == expected.n_dependences);
      CHECK(totals(g).n_iterations == expected.n_iterations);
    }
}

TEST_CASE("graphs whose options do not fit each other are refused", "[task_bench]") {
  Graph g = graph_of("stencil_1d", 8);
  g.period = 2;
  CHECK_THROWS_WITH(validate(g), Contains("stencil_1d has none"));
  g = graph_of("spread", 8);
  g.period = 4;
  CHECK_THROWS_WITH(validate(g), Contains("at most 3"));
  g = graph_of("trivial", 8);
  g.kernel.type = KernelType::memory_bound;
  CHECK_THROWS_WITH(validate(g), Contains("at least 256"));
  g.kernel = {};
  g.kernel.imbalance = 1;
  CHECK_THROWS_WITH(validate(g), Contains("load_imbalance"));
  CHECK_THROWS_WITH(parse_type("torus"), Contains("stencil_1d_periodic"));
  CHECK_THROWS_WITH(parse_kernel("gemm"), Contains("busy_wait"));
}

TEST_CASE("inputs are complete when each dependence has its output, in any order", "[task_bench]") {
  const Graph g = graph_of("stencil_1d", 5);
  Inputs inputs(g, 2);
  REQUIRE(inputs.complete());  // step 0 has none
  inputs.advance();
  CHECK_FALSE(inputs.complete());
  for (std::int64_t ahead = 6; ahead >= 0; --ahead) {  // also far ahead
    CHECK(inputs.put({ahead, 3}));
    CHECK(inputs.put({ahead, 1}));
  }
  for (std::int64_t step = 1; step <= 7; ++step) {
    CHECK_FALSE(inputs.complete());
    REQUIRE(inputs.put({step - 1, 2}));
    REQUIRE(inputs.complete());
    CHECK(inputs.right());
    inputs.advance();
  }
}

TEST_CASE("an output that stands for no dependence is refused", "[task_bench]") {
  const Graph g = graph_of("nearest", 9);
  Inputs inputs(g, 4);
  inputs.advance();
  CHECK(inputs.put({0, 3}));
  CHECK_FALSE(inputs.put({0, 3}));  // twice
  CHECK_FALSE(inputs.put({0, 6}));  // not a neighbour
  CHECK_FALSE(inputs.put({0, -1}));
  CHECK_FALSE(inputs.put({-1, 3}));  // of a step that is over
  CHECK_FALSE(inputs.put({19, 3}));  // of the last step: nothing depends on it
  CHECK_THAT(inputs.complaint({0, 6}), Contains("(step 0, point 6)"));
}

TEST_CASE("inputs of every graph run through as its tasks do, and again", "[task_bench]") {
  for (const std::string& type : type_names())
    for (const std::int32_t width : {1, 4, 7}) {
      const Graph g = graph_of(type, width, 12);
      std::vector<Inputs> all;
      for (std::int32_t p = 0; p < width; ++p) all.emplace_back(g, p);
      INFO(type << ", width " << width);
      for (int round = 0; round < 2; ++round) {
        std::uint64_t n_tasks = 0, n_inputs = 0;
        for (std::int64_t step = 0; step < g.steps; ++step) {
          std::vector<std::pair<std::int32_t, Output>> sent;
          for (std::int32_t p = 0; p < width; ++p) {
            Inputs& inputs = all[static_cast<std::size_t>(p)];
            REQUIRE(inputs.step() == step);
            if (points_at(g, step).contains(p)) {
              REQUIRE(inputs.complete());
              REQUIRE(inputs.right());
              ++n_tasks;
              n_inputs += static_cast<std::uint64_t>(inputs.n_needed());
              for (const std::int32_t q : inputs.consumers())
                if (points_at(g, step + 1).contains(q) && step + 1 < g.steps)
                  sent.push_back({q, {step, p}});
            }
            inputs.advance();
          }
          for (const auto& [to, output] : sent)
            REQUIRE(all[static_cast<std::size_t>(to)].put(output));
        }
        CHECK(n_tasks == totals(g).n_tasks);
        CHECK(n_inputs == totals(g).n_dependences);
        for (Inputs& inputs : all) inputs.rewind();
      }
    }
}

TEST_CASE("imbalanced iterations are spread evenly round their mean", "[task_bench]") {
  Kernel kernel{KernelType::load_imbalance, 1000};
  kernel.imbalance = 2;
  double sum = 0, least = 1e9, most = 0;
  for (std::int32_t p = 0; p < 10000; ++p) {
    const auto n = static_cast<double>(iterations_of(kernel, 0, 7, p));
    sum += n;
    least = std::min(least, n);
    most = std::max(most, n);
  }
  CHECK(sum / 10000 == Approx(1000).epsilon(0.02));
  CHECK(least < 20);
  CHECK(least >= 0);
  CHECK(most > 1980);
  CHECK(most <= 2000);
  CHECK(iterations_of(kernel, 0, 7, 3) != iterations_of(kernel, 0, 8, 3));
  kernel.persistent = true;
  CHECK(iterations_of(kernel, 0, 7, 3) == iterations_of(kernel, 0, 8, 3));
  kernel.imbalance = 0;
  CHECK(iterations_of(kernel, 0, 7, 3) == 1000);
}

TEST_CASE("a kernel takes longer with more iterations", "[task_bench]") {
  for (const std::string& name : kernel_names()) {
    if (name == "empty") continue;
    Kernel kernel{parse_kernel(name)};
    kernel.scratch_bytes = 1 << 16;
    INFO(name);
    CHECK(calibrate(kernel, 3000) > 3 * calibrate(kernel, 300));
  }
}

TEST_CASE("the search finds where a known overhead takes half of the time", "[task_bench]") {
  for (const double overhead : {2e-8, 1e-7, 3e-6, 1e-4}) {
    MetgSearch search;
    int n = 0;
    while (const auto iterations = search.next()) {
      REQUIRE(++n < 60);
      Row row;
      row.iterations = *iterations;
      row.grain_seconds = 4e-9 * static_cast<double>(*iterations);
      row.pes = 2;
      row.n_tasks = 1000;
      row.seconds = 500 * (row.grain_seconds + overhead);
      row.efficiency = row.grain_seconds / (row.grain_seconds + overhead);
      search.tell(row);
    }
    const auto found = search.found();
    REQUIRE(found);
    CHECK_FALSE(found->below);
    CHECK(found->grain_seconds == Approx(overhead).epsilon(0.03));
    CHECK(found->wall_seconds == Approx(2 * overhead).epsilon(0.03));
    CHECK(search.rows().size() == static_cast<std::size_t>(n));
  }
}

TEST_CASE("the search ends where no grain, or every grain, is half efficient", "[task_bench]") {
  for (const double efficiency : {0.2, 0.9}) {
    MetgSearch search;
    int n = 0;
    while (const auto iterations = search.next()) {
      REQUIRE(++n < 60);
      Row row;
      row.iterations = *iterations;
      row.n_tasks = 1;
      row.efficiency = efficiency;
      search.tell(row);
    }
    CHECK(search.found().has_value() == (efficiency > 0.5));
    if (search.found()) CHECK(search.found()->below);
  }
}
