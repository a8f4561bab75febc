#include "runtime/balance_options.hpp"

#include "runtime/balance/prediction.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <set>
#include <string_view>

namespace tess {
namespace {

double number(std::string_view key, std::string_view value, std::string_view* rest) {
  *rest = value;
  const auto number = take_number<double>(*rest);
  if (!number || !(*number >= 0))
    fail(ErrorCode::bad_argument, "--balance ", key, ": ", value, " is not a number of at least 0");
  return *number;
}

std::uint64_t whole(std::string_view key, std::string_view value) {
  const auto number = parse_number<std::uint64_t>(value);
  if (!number)
    fail(ErrorCode::bad_argument, "--balance ", key, ": ", value, " is not a whole number");
  return *number;
}

std::chrono::nanoseconds time(std::string_view key, std::string_view value) {
  std::string_view unit;
  const double count = number(key, value, &unit);
  const double factor = unit == "us" ? 1e3 : unit == "ms" ? 1e6 : unit == "s" ? 1e9 : 0;
  constexpr double most = 1e18;  // nanoseconds
  if (factor == 0 || !(count * factor <= most))
    fail(ErrorCode::bad_argument, "--balance ", key, ": ", value,
         " is not a time (a number with us, ms or s, at most 1e9s)");
  return std::chrono::nanoseconds(static_cast<std::int64_t>(count * factor));
}

BalanceWhen parse_when(std::string_view value) {
  if (value == "at_sync") return BalanceWhen::at_sync;
  if (value == "periodic") return BalanceWhen::periodic;
  if (value == "automatic") return BalanceWhen::automatic;
  fail(ErrorCode::bad_argument, "--balance when: ", value,
       " is not one of at_sync, periodic, automatic",
       did_you_mean(value, "at_sync periodic automatic"));
}

}  // namespace

BalanceOptions parse_balance(std::string_view given) {
  if (given.empty())
    fail(ErrorCode::bad_argument, "--balance: is empty; give a strategy, or leave it out");
  BalanceOptions options;
  std::set<std::string_view> keys;
  for (bool first = true; !given.empty(); first = false) {
    const std::size_t comma = std::min(given.find(','), given.size());
    const std::string_view part = given.substr(0, comma);
    given.remove_prefix(std::min(comma + 1, given.size()));
    const std::size_t equals = part.find('=');
    const std::string_view key = part.substr(0, equals);
    const std::string_view value =
        equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1);
    const bool is_word = equals == std::string_view::npos;
    const bool is_strategy = first && is_word && key != "report";
    if (!keys.insert(is_strategy ? "strategy" : key).second)
      fail(ErrorCode::bad_argument, "--balance: ", key, " is given twice; give it once");
    if (key == "strategy") {
      options.strategy = value;
    } else if (key == "when") {
      options.when = parse_when(value);
    } else if (key == "period") {
      options.period = time(key, value);
    } else if (key == "prediction") {
      options.prediction = value;
    } else if (key == "window") {
      options.window = whole(key, value);
    } else if (key == "seed") {
      options.seed = whole(key, value);
    } else if (key == "report" && is_word) {
      options.lines = RoundLines::print;
    } else if (is_strategy) {
      options.strategy = key;
    } else {
      constexpr std::string_view names = "strategy, when, period, prediction, window, seed, report";
      fail(ErrorCode::bad_argument, "--balance: unknown key ", key == "report" ? part : key, " (",
           names, ")", did_you_mean(key == "report" ? "" : key, names));
    }
  }
  if (keys.contains("period") && options.when != BalanceWhen::periodic)
    fail(ErrorCode::bad_argument,
         "--balance period: is for when=periodic; add that, or leave the period out");
  balance::validate(options, 0);
  return options;
}

void balance::validate(const BalanceOptions& options, std::int32_t n_pes, StrategyOf strategy) {
  const bool is_users = strategy == StrategyOf::user;
  if (!is_users) (void)make_strategy(options.strategy, options.seed);
  if (parse_prediction(options.prediction) != Prediction::last && !is_users &&
      is_distributed(options.strategy))
    fail(ErrorCode::bad_argument, "balance prediction: ", options.prediction, ", but ",
         options.strategy,
         " is distributed and knows the last phase only; choose last, or another strategy");
  if (options.window == 0)
    fail(ErrorCode::bad_argument, "balance window: 0 phases; a prediction looks back at least one");
  if (options.when == BalanceWhen::periodic && options.period.count() <= 0)
    fail(ErrorCode::bad_argument,
         "balance period: periodic rounds need one above 0, as period=50ms");
  if (n_pes == 0) return;
  const auto fits = [n_pes](std::size_t n) {
    return n == 0 || n == static_cast<std::size_t>(n_pes);
  };
  if (!fits(options.speeds.size()))
    fail(ErrorCode::bad_argument, "balance speeds: ", options.speeds.size(),
         " are given, the run has ", n_pes, " PEs");
  for (const double speed : options.speeds)
    if (!(speed > 0 && speed < 1e9))
      fail(ErrorCode::bad_argument, "balance speeds: ", speed, " is not above 0 and below 1e9");
  if (!fits(options.memory_limit_bytes.size()))
    fail(ErrorCode::bad_argument, "balance memory limits: ", options.memory_limit_bytes.size(),
         " are given, the run has ", n_pes, " PEs");
}

void balance::require_no_positions(const BalanceOptions& options, std::string_view chare) {
  if (!needs_positions(options.strategy)) return;
  fail(ErrorCode::bad_argument, "balance strategy ", options.strategy, ": elements of ", chare,
       " have no position; choose another strategy, or define balance_position() in the chare");
}

}  // namespace tess
