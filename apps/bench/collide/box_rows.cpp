#include "apps/bench/collide/method.hpp"
#include "apps/bench/collide/one_core.hpp"
#include "apps/bench/collide/peak_memory.hpp"
#include "apps/bench/collide/rows.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/core.h>
#include <iterator>
#include <map>

namespace bench {
namespace {

using Pairs = std::vector<PackedPair>;

/// Short work is repeated until a sample lasts so long.
constexpr double kSampleNanoseconds = 2e7;

/// A method and what was found out about it.
struct Run {
  const MethodKind* kind;
  std::unique_ptr<Method> method;
  std::uint64_t n_pairs = 0;
  std::int64_t times = 1;
  Samples nanoseconds = {};  // per object
};

void require(bool holds, const std::string& of, std::string_view method, const std::string& what) {
  if (!holds)
    tess::fail(tess::ErrorCode::bad_value, "benchmark: wrong result: ", of, ", ", method, ": ",
               what);
}

Pairs sorted_pairs(Method& method) {
  Pairs pairs = method.pairs();
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}
std::uint64_t n_twice(const Pairs& sorted) {
  std::uint64_t n = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] == sorted[i - 1]) ++n;
  return n;
}
/// How many of `of` are not in `in`.
std::uint64_t n_missing(const Pairs& of, const Pairs& in) {
  std::uint64_t n = 0;
  auto at = in.begin();
  for (const PackedPair pair : of) {
    while (at != in.end() && *at < pair) ++at;
    if (at == in.end() || *at != pair) ++n;
  }
  return n;
}

/// Merges the small blocks that a method freed: otherwise the first large allocation of the next
/// one does it and pays for it. After FCL, which frees a million nodes, that is 85 ns per object.
void tidy_heap() {
  void* volatile large = std::malloc(std::size_t{1} << 16);
  std::free(large);
}

/// Brute force checks every problem that is small enough, and has a row where it is compared.
bool is_listed(const MethodKind& kind, const Case& of) {
  return kind.whose != Whose::brute_force || of.name == "few";
}

class BoxCase {
 public:
  BoxCase(Output& output, const Case& of, const std::map<std::string, std::size_t>& peaks)
      : output_(output), case_(of), peaks_(peaks), problem_(make_problem(of)) {}

  void measure() {
    std::vector<Run> runs = wanted_runs();
    for (Run& run : runs) check(run);
    if (std::any_of(runs.begin(), runs.end(), [&](const Run& run) {
          return output_.wants(case_.name, name(run.kind->name));
        }))
      time(runs);
    output_.row(case_.name, name("pairs"), static_cast<double>(expected_.size()), "pairs");
    for (const auto& [what, n] : differences_)
      output_.row(case_.name, name(what), static_cast<double>(n), "pairs");
    for (const auto& [row, bytes] : peaks_)
      if (row.starts_with(case_.name + "_"))
        output_.row(case_.name, row,
                    static_cast<double>(bytes) / static_cast<double>(problem_.boxes.size()),
                    "bytes");
  }

 private:
  void time(std::vector<Run>& runs) {
    for (int i = 0; i < output_.options().repeat; ++i)
      for (std::size_t k = 0; k < runs.size(); ++k)
        sample(runs[(k + static_cast<std::size_t>(i)) % runs.size()]);
    double limit = 0;  // the fastest peer
    for (const Run& run : runs)
      if (run.kind->whose == Whose::peer && (limit == 0 || run.nanoseconds.median() < limit))
        limit = run.nanoseconds.median();
    for (const Run& run : runs)
      if (is_listed(*run.kind, case_))
        output_.row(case_.name, name(run.kind->name), run.nanoseconds, "ns",
                    run.kind->whose == Whose::ours ? limit : 0);
  }

  [[nodiscard]] std::string name(std::string_view row) const {
    return fmt::format("{}_{}", case_.name, row);
  }

  /// Ours, and others that have a row.
  [[nodiscard]] std::vector<Run> wanted_runs() const {
    std::vector<Run> runs;
    for (const MethodKind& kind : method_kinds()) {
      const std::string row = name(kind.name);
      if (kind.whose != Whose::ours && !output_.wants(case_.name, row) && !output_.wants_any(row))
        continue;
      if (auto method = kind.make(problem_)) runs.push_back({&kind, std::move(method)});
    }
    return runs;
  }

  /// The first run, which also warms up: compares its pairs with those of the first method, ours on
  /// doubles.
  void check(Run& run) {
    const std::string_view kind = run.kind->name;
    const Pairs pairs = sorted_pairs(*run.method);
    run.n_pairs = pairs.size();
    const std::uint64_t twice = n_twice(pairs);
    require(twice == 0, case_.name, kind, fmt::format("{} pairs are found twice", twice));
    if (expected_.empty() && run.kind->whose == Whose::ours && kind == "double") {
      expected_ = pairs;
      return;
    }
    if (kind == "float") {
      const Problem same = widened(problem_);
      const Pairs wanted = sorted_pairs(*our_doubles(same));
      require(pairs == wanted, case_.name, kind,
              fmt::format("{} pairs, but {} of the same boxes as doubles", pairs.size(),
                          wanted.size()));
      return;
    }
    require(pairs == expected_, case_.name, kind,
            fmt::format("{} of our pairs are missing, {} are false", n_missing(expected_, pairs),
                        n_missing(pairs, expected_)));
    if (case_.exact) return;
    if (kind == "embree") count_candidates(*run.method);
    if (kind == "fcl") count_lost(*fcl_centred_pairs(problem_));
  }

  /// What Embree passes on beyond the pairs: boxes that overlap by their rounding, and the rest of
  /// a leaf.
  void count_candidates(Method& embree) {
    std::uint64_t rounded = 0, more = 0;
    auto at = expected_.begin();
    Pairs candidates = embree.candidates();
    std::sort(candidates.begin(), candidates.end());
    for (const PackedPair pair : candidates) {
      while (at != expected_.end() && *at < pair) ++at;
      if (at != expected_.end() && *at == pair) continue;
      ++more;
      const FloatBox a = rounded_outward(problem_.boxes[pair >> 32]),
                     b = rounded_outward(problem_.boxes[pair & 0xFFFFFFFFu]);
      bool touches = true;
      for (std::size_t k = 0; k < 3; ++k)
        touches = touches && a.lo[k] <= b.hi[k] && b.lo[k] <= a.hi[k];
      if (touches) ++rounded;
    }
    differences_.emplace_back("embree_rounded", rounded);
    differences_.emplace_back("embree_leaves", more - rounded);
  }

  void count_lost(Method& centred) {
    const Pairs pairs = sorted_pairs(centred);
    differences_.emplace_back("fcl_lost", n_missing(expected_, pairs));
    differences_.emplace_back("fcl_added", n_missing(pairs, expected_));
  }

  void sample(Run& run) {
    tidy_heap();
    for (;;) {
      const ProcessWatch watch;
      for (std::int64_t i = 0; i < run.times; ++i) {
        const std::uint64_t n = run.method->count();
        require(n == run.n_pairs, case_.name, run.kind->name,
                fmt::format("{} pairs, and {} another time", n, run.n_pairs));
      }
      const double took = watch.nanoseconds();
      tidy_heap();
      if (took < kSampleNanoseconds / 2 && run.nanoseconds.empty()) {
        run.times *= 2;
        continue;
      }
      run.nanoseconds.add(took / static_cast<double>(run.times) /
                          static_cast<double>(problem_.boxes.size()));
      return;
    }
  }

  Output& output_;
  const Case& case_;
  const std::map<std::string, std::size_t>& peaks_;
  Problem problem_;
  Pairs expected_;
  std::vector<std::pair<std::string, std::uint64_t>> differences_;
};

/// Peak memory of our methods beside the input, by row.
std::map<std::string, std::size_t> peaks_of(const Output& output, const Case& of) {
  std::map<std::string, std::size_t> peaks;
  Problem problem;
  for (const MethodKind& kind : method_kinds()) {
    const std::string row = fmt::format("{}_{}_bytes", of.name, kind.name);
    if (kind.whose != Whose::ours || !output.wants(of.name, row)) continue;
    if (problem.boxes.empty()) problem = make_problem(of);
    const auto method = kind.make(problem);
    if (method) peaks[row] = peak_bytes([&] { (void)method->count(); });
  }
  return peaks;
}

/// True if a row of the case is wanted that is none of chare_rows().
bool wants_box_rows(const Output& output, const std::string& of_case) {
  if (output.wants(of_case, of_case)) return true;
  for (const auto& [row, meaning] : box_row_texts(of_case))
    if (output.wants(of_case, row)) return true;
  return false;
}

Case sized(const Output& output, const Case& of) {
  return output.options().quick ? smaller(of, 64) : of;
}

}  // namespace

RowTexts box_row_texts(const std::string& of_case) {
  const auto all = box_cases();
  const auto of =
      std::find_if(all.begin(), all.end(), [&](const Case& each) { return each.name == of_case; });
  const Problem small = make_problem(smaller(*of, 1024));
  RowTexts rows;
  const auto add = [&](std::string_view row, std::string_view meaning) {
    rows.emplace_back(fmt::format("{}_{}", of_case, row), meaning);
  };
  const auto can = [&](std::string_view name) {
    for (const MethodKind& kind : method_kinds())
      if (kind.name == name) return kind.make(small) != nullptr;
    return false;
  };
  for (const MethodKind& kind : method_kinds())
    if (can(kind.name) && is_listed(kind, *of))
      add(kind.name, fmt::format("ns per object: {}", kind.meaning));
  add("pairs", "pairs that are wanted");
  if (can("embree") && !of->exact) {
    add("embree_rounded",
        "pairs that Embree adds, because its boxes are rounded outward to floats");
    add("embree_leaves", "pairs that Embree passes on although its boxes do not overlap");
  }
  if (can("fcl") && !of->exact) {
    add("fcl_lost", "pairs that FCL loses if its boxes are given by centre and sides");
    add("fcl_added", "false pairs that it finds then");
  }
  for (const MethodKind& kind : method_kinds())
    if (kind.whose == Whose::ours && can(kind.name))
      add(fmt::format("{}_bytes", kind.name),
          "bytes per object at the peak of the first run, beside the input");
  return rows;
}

void box_rows(Output& output) {
  std::map<std::string, std::size_t> peaks;
  for (const Case& of : box_cases())
    if (wants_box_rows(output, of.name)) peaks.merge(peaks_of(output, sized(output, of)));
  for (const Case& each : box_cases()) {
    if (!wants_box_rows(output, each.name)) continue;
    const Case of = sized(output, each);
    BoxCase(output, of, peaks).measure();
  }
}

void growth_rows(Output& output) {
  const auto all = box_cases();
  for (const char* const name : {"wave_self", "boxes", "disparity"}) {
    const Case of =
        *std::find_if(all.begin(), all.end(), [&](const Case& each) { return each.name == name; });
    std::map<std::string_view, Samples> extremes;
    for (int log = 10; log <= (output.options().quick ? 12 : 22); ++log) {
      Case grown = of;
      grown.scene = fmt::format("{}:{}", of.scene.substr(0, of.scene.find(':')), 1 << log);
      // Small scenes are searched in turns, each with another seed: of one small scene the
      // processor learns every branch, which makes 1 024 objects a third faster than they are in a
      // program.
      const int n_scenes = std::max(1, (1 << 17) >> log);
      std::vector<Problem> problems;
      for (int i = 0; i < n_scenes; ++i)
        problems.push_back(make_problem(grown, static_cast<std::uint64_t>(i) + 1));
      for (const MethodKind& kind : method_kinds()) {
        if (kind.whose != Whose::ours) continue;
        std::vector<std::unique_ptr<Method>> methods;
        std::vector<std::uint64_t> expected;
        for (const Problem& problem : problems) {
          auto method = kind.make(problem);
          if (!method) break;
          expected.push_back(method->count());
          methods.push_back(std::move(method));
        }
        if (methods.size() != problems.size()) continue;
        Samples samples;
        for (int i = 0; i < output.options().repeat; ++i) {
          const ProcessWatch watch;
          for (std::size_t k = 0; k < methods.size(); ++k)
            require(methods[k]->count() == expected[k], grown.scene, kind.name, "another count");
          samples.add(watch.nanoseconds() / static_cast<double>(std::int64_t{n_scenes} << log));
        }
        output.row("growth", fmt::format("growth_{}_{}_{}", name, kind.name, 1 << log), samples,
                   "ns");
        extremes[kind.name].add(samples.median());
      }
    }
    for (const auto& [kind, medians] : extremes)
      output.row("growth", fmt::format("growth_{}_{}_spread", name, kind), medians.spread(),
                 "of the median");
  }
}

}  // namespace bench
