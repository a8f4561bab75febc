#include "apps/lb_lab/run/settings.hpp"

#include "runtime/balance/prediction.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>

namespace lb_lab {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  tess::fail(tess::ErrorCode::bad_argument, parts...);
}

/// Why a strategy cannot serve these settings, as a sentence; empty if it can.
std::string obstacle(const Settings& s, const std::string& name) {
  if (tess::balance::is_distributed(name) &&
      tess::balance::parse_prediction(s.prediction) != tess::balance::Prediction::last)
    return "it is distributed and knows the last phase only, without --prediction " + s.prediction;
  return tess::balance::obstacle(name, {});
}

/// A row, and the file of a snapshot, would stand for two runs.
template <class Value>
void refuse_repeated(const char* option, const std::vector<Value>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::count(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) > 0)
      refuse(option, ": ", values[i], " is given twice; give each value once");
}

void expand_names(Settings& s) {
  refuse_repeated("--workload", s.workloads);
  refuse_repeated("--per-pe", s.per_pe);
  refuse_repeated("--strategy", s.strategies);
  for (const std::string& name : s.workloads)
    if (name != "all") (void)find_workload(name);
  require_strategies(s);
  if (std::ranges::count(s.workloads, "all") > 0) {
    s.workloads.clear();
    for (const Workload& one : workloads()) s.workloads.push_back(one.name);
  }
  if (std::ranges::count(s.strategies, "all") > 0) {
    s.strategies.clear();
    for (const std::string& name : tess::balance::strategy_names()) {
      const std::string why = obstacle(s, name);
      (why.empty() ? s.strategies : s.left_out).push_back(why.empty() ? name : name + ": " + why);
    }
  }
  for (const std::string& name : s.strategies)
    if (const std::string why = obstacle(s, name); !why.empty())
      refuse("--strategy: ", name, ": ", why, "; choose another, or all, which leaves it out");
  // What is gained is gained over none.
  std::erase(s.strategies, "none");
  s.strategies.insert(s.strategies.begin(), "none");
}

}  // namespace

double parse_time(std::string_view option, std::string_view value) {
  std::string_view unit = value;
  const double count = tess::take_number<double>(unit).value_or(0);
  const double unit_seconds = unit == "us" ? 1e-6 : unit == "ms" ? 1e-3 : unit == "s" ? 1 : 0;
  if (!(count * unit_seconds > 0) || count * unit_seconds > 1e6)
    refuse(option, ": ", value, " is not a time above 0; give 250us, 1ms, 0.5s or the like");
  return count * unit_seconds;
}

void require_strategies(const Settings& s) {
  for (const std::string& name : s.strategies)
    if (name != "all") (void)tess::balance::make_strategy(name, s.seed);
}

std::vector<std::uint64_t> limits_of_pes(const Settings& s, std::size_t n_pes) {
  if (s.memory_limits.empty()) return {};
  if (s.memory_limits.size() == 1)
    return std::vector<std::uint64_t>(n_pes, s.memory_limits.front());
  if (s.memory_limits.size() != n_pes)
    refuse("--memory-limit: ", s.memory_limits.size(), " limits for ", n_pes,
           " PEs; give one, or one per PE");
  return s.memory_limits;
}

tess::BalanceWhen parse_when(std::string_view value) {
  if (value == "at_sync") return tess::BalanceWhen::at_sync;
  if (value == "periodic") return tess::BalanceWhen::periodic;
  if (value == "automatic") return tess::BalanceWhen::automatic;
  refuse("--when: ", value, " is not a kind of rounds; choose at_sync, periodic or automatic",
         tess::did_you_mean(value, "at_sync periodic automatic"));
}

Problem problem_of(const Settings& s, std::uint32_t workload, std::int32_t n_pes) {
  const std::int32_t n_finest = n_pes * std::ranges::max(s.per_pe);
  Problem p;
  p.workload = workload;
  p.domain = workloads()[workload].shape == Shape::plane ? plane_of(n_finest) : line_of(n_finest);
  p.n_pes = n_pes;
  p.n_iterations = s.n_iterations;
  p.seed = s.seed;
  p.cell_seconds =
      parse_time("--grain", s.grain) * n_finest / static_cast<double>(p.domain.n_cells());
  p.cell_bytes = s.cell_bytes * static_cast<std::uint64_t>(n_finest) /
                 static_cast<std::uint64_t>(p.domain.n_cells());
  p.message_bytes = s.message_bytes;
  return p;
}

void complete(Settings& s, std::int32_t n_pes) {
  expand_names(s);
  (void)parse_time("--grain", s.grain);
  (void)parse_when(s.when);
  (void)tess::balance::parse_prediction(s.prediction);
  for (const std::int32_t n : s.per_pe)
    if (n < 1 || std::int64_t{n} * n_pes > 1 << 24)
      refuse("--per-pe: ", n, " chares on each of ", n_pes, " PEs; give 1 to ", (1 << 24) / n_pes);
  if (s.period < 1 || s.period > s.n_iterations)
    refuse("--period: ", s.period, " iterations; give 1 to --iterations ", s.n_iterations);
  if (s.period == s.n_iterations && s.strategies.size() > 1 && s.when != "periodic")
    refuse(
        "--period: ", s.period, " iterations: no round would be held for ", s.strategies.back(),
        ", since a round after the last iteration gains nothing; give fewer, or more --iterations");
  if (!s.speeds.empty() && s.speeds.size() != static_cast<std::size_t>(n_pes))
    refuse("--speed: ", s.speeds.size(), " speeds for ", n_pes, " PEs; give one per PE");
  (void)limits_of_pes(s, static_cast<std::size_t>(n_pes));
  for (const double speed : s.speeds)
    if (!(speed >= 1e-3 && speed <= 1e3))
      refuse("--speed: ", speed, " is not within 0.001 and 1000");
  for (const std::string& name : s.workloads)
    for (const std::int32_t n : s.per_pe)
      (void)cut(problem_of(s, find_workload(name), n_pes).domain, n * n_pes);
}

}  // namespace lb_lab
