#include "apps/task_bench/graph.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace task_bench {
namespace {

/// Ascending, each once, within the width.
std::vector<std::int32_t> tidy(std::vector<std::int64_t> points, std::int32_t width) {
  std::ranges::sort(points);
  std::vector<std::int32_t> result;
  for (const std::int64_t point : points)
    if (0 <= point && point < width && (result.empty() || result.back() != point))
      result.push_back(static_cast<std::int32_t>(point));
  return result;
}

std::vector<std::int64_t> between(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> points;
  for (std::int64_t point = first; point <= last; ++point) points.push_back(point);
  return points;
}

std::int64_t wrapped(std::int64_t point, std::int64_t width) {
  return (point % width + width) % width;
}

/// Whether random_nearest has the edge from an output to an input.
bool has_random_edge(const Graph& g, std::int32_t set, std::int64_t from, std::int64_t to) {
  if (from == to) return true;
  std::uint64_t hash = 0x7461736b;
  for (const std::int64_t part :
       {std::int64_t{g.number}, std::int64_t{g.radix}, std::int64_t{set}, from, to})
    hash = tess::mix(hash ^ static_cast<std::uint64_t>(part));
  return tess::Random(hash).unit() < g.fraction;
}

/// Points of a window below and above a point; radix points with itself.
struct Window {
  std::int64_t below, above;
};
Window window_of_inputs(const Graph& g) {
  return {g.radix / 2, (g.radix - 1) / 2};
}

std::vector<std::int64_t> spread_points(const Graph& g, std::int32_t set, std::int32_t point,
                                        std::int64_t direction) {
  std::vector<std::int64_t> points;
  for (std::int64_t i = 0; i < g.radix; ++i) {
    const std::int64_t distance = i * g.width / g.radix + (i > 0 ? set : 0);
    points.push_back(wrapped(point + direction * distance, g.width));
  }
  return points;
}

}  // namespace

const std::vector<std::string>& type_names() {
  static const std::vector<std::string> names{
      "trivial",    "no_comm", "stencil_1d", "stencil_1d_periodic", "dom", "tree", "fft",
      "all_to_all", "nearest", "spread",     "random_nearest"};
  return names;
}

const std::string& name_of(Type type) {
  return type_names()[static_cast<std::size_t>(type)];
}

Type parse_type(std::string_view name) {
  const auto& names = type_names();
  const auto at = std::ranges::find(names, name);
  if (at == names.end()) refuse_name("-type", name, names);
  return static_cast<Type>(at - names.begin());
}

bool has_period(Type type) {
  return type == Type::spread || type == Type::random_nearest;
}

Points points_at(const Graph& g, std::int64_t step) {
  if (step < 0) return {};
  const auto point = [&g](std::int64_t n) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(n, 0, g.width));
  };
  switch (g.type) {
    case Type::dom: {
      const std::int32_t first = point(step + g.width - g.steps);
      return {first, first + point(std::min(step + 1, g.steps - step))};
    }
    case Type::tree:
      return {0, step >= 31 ? g.width : point(std::int64_t{1} << step)};
    default:
      return {0, g.width};
  }
}

std::int32_t n_sets(const Graph& g) {
  if (g.type == Type::fft)
    return std::max(1, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(g.width) - 1)));
  return has_period(g.type) ? g.period : 1;
}

std::int32_t set_at(const Graph& g, std::int64_t step) {
  // The first stage of an fft is that of step 1.
  const std::int64_t at = g.type == Type::fft ? step - 1 : step;
  return static_cast<std::int32_t>(wrapped(at, n_sets(g)));
}

std::vector<std::int32_t> dependences(const Graph& g, std::int32_t set, std::int32_t point) {
  const std::int64_t p = point;
  const std::int64_t stride = std::int64_t{1} << set;
  const Window window = window_of_inputs(g);
  switch (g.type) {
    case Type::trivial:
      return {};
    case Type::no_comm:
      return {point};
    case Type::stencil_1d:
      return tidy({p - 1, p, p + 1}, g.width);
    case Type::stencil_1d_periodic:
      return tidy({wrapped(p - 1, g.width), p, wrapped(p + 1, g.width)}, g.width);
    case Type::dom:
      return tidy({p - 1, p}, g.width);
    case Type::tree:
      return tidy({p / 2}, g.width);
    case Type::fft:
      return tidy({p - stride, p, p + stride}, g.width);
    case Type::all_to_all:
      return tidy(between(0, g.width - 1), g.width);
    case Type::nearest:
      if (g.radix == 0) return {};
      return tidy(between(p - window.below, p + window.above), g.width);
    case Type::spread:
      return tidy(spread_points(g, set, point, 1), g.width);
    case Type::random_nearest: {
      if (g.radix == 0) return {};
      std::vector<std::int64_t> points = between(p - window.below, p + window.above);
      std::erase_if(points, [&](std::int64_t from) { return !has_random_edge(g, set, from, p); });
      return tidy(std::move(points), g.width);
    }
  }
  return {};
}

std::vector<std::int32_t> dependents(const Graph& g, std::int32_t set, std::int32_t point) {
  const std::int64_t p = point;
  const Window window = window_of_inputs(g);  // mirrored: what is above the one is below the other
  switch (g.type) {
    case Type::dom:
      return tidy({p, p + 1}, g.width);
    case Type::tree:
      return tidy({2 * p, 2 * p + 1}, g.width);
    case Type::nearest:
      if (g.radix == 0) return {};
      return tidy(between(p - window.above, p + window.below), g.width);
    case Type::spread:
      return tidy(spread_points(g, set, point, -1), g.width);
    case Type::random_nearest: {
      if (g.radix == 0) return {};
      std::vector<std::int64_t> points = between(p - window.above, p + window.below);
      std::erase_if(points, [&](std::int64_t to) { return !has_random_edge(g, set, p, to); });
      return tidy(std::move(points), g.width);
    }
    default:
      return dependences(g, set, point);  // symmetric
  }
}

Totals totals(const Graph& g) {
  std::vector<std::uint64_t> of_set(static_cast<std::size_t>(n_sets(g)), 0);
  for (std::size_t set = 0; set < of_set.size(); ++set)
    for (std::int32_t p = 0; p < g.width; ++p)
      of_set[set] += dependences(g, static_cast<std::int32_t>(set), p).size();
  Totals result;
  for (std::int64_t step = 0; step < g.steps; ++step) {
    const Points now = points_at(g, step), before = points_at(g, step - 1);
    const auto n_points = static_cast<std::uint64_t>(now.end - now.first);
    result.n_tasks += n_points;
    if (g.kernel.type != KernelType::load_imbalance) {
      result.n_iterations += n_points * static_cast<std::uint64_t>(g.kernel.iterations);
    } else {
      for (std::int32_t p = now.first; p < now.end; ++p)
        result.n_iterations +=
            static_cast<std::uint64_t>(iterations_of(g.kernel, g.number, step, p));
    }
    const std::int32_t set = set_at(g, step);
    if (now.end - now.first == g.width && before.end - before.first == g.width) {
      result.n_dependences += of_set[static_cast<std::size_t>(set)];
    } else if (before.end > before.first) {
      for (std::int32_t p = now.first; p < now.end; ++p)
        for (const std::int32_t q : dependences(g, set, p))
          result.n_dependences += before.contains(q) ? 1U : 0U;
    }
  }
  return result;
}

void validate(const Graph& g) {
  const auto refuse = [](const std::string& why) {
    tess::fail(tess::ErrorCode::bad_argument, why);
  };
  if (has_period(g.type) && g.period == 0)
    refuse(fmt::format("-period: {} needs one above 0", name_of(g.type)));
  if (!has_period(g.type) && g.period != 0)
    refuse(fmt::format("-period: {} has none; leave it out", name_of(g.type)));
  if (g.type == Type::spread) {
    if (g.radix == 0) refuse("-radix: spread needs one above 0");
    // Later dependence sets would come round to the points of the first.
    const std::int32_t most = (g.width + g.radix - 1) / g.radix;
    if (g.period > most)
      refuse(fmt::format("-period {}: at most {} for spread with -width {} and -radix {}", g.period,
                         most, g.width, g.radix));
  }
  validate(g.kernel);
}

}  // namespace task_bench
