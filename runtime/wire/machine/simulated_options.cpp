#include "runtime/wire/machine/simulated_options.hpp"

#include "runtime/base/words.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace tess::detail {
namespace {

constexpr std::int64_t most_seed = 9'000'000'000'000'000;

/// "2us" of the key "latency"; `place` names both for an error: "--sim latency", "here.sim:3:
/// latency".
struct Value {
  std::string place, text;

  /// What stands before the unit.
  double number(std::string_view* unit) const {
    *unit = text;
    const auto number = take_number<double>(*unit);
    if (!number || !std::isfinite(*number))
      fail(ErrorCode::bad_argument, place, ": ", text, " is not a number");
    return *number;
  }
  [[nodiscard]] Time time() const {
    std::string_view unit;
    const double value = number(&unit);
    const double factor = unit == "ns"                 ? 1
                          : unit == "us"               ? 1e3
                          : unit == "ms"               ? 1e6
                          : unit == "s"                ? 1e9
                          : unit.empty() && value == 0 ? 0
                                                       : -1;
    constexpr double most = 1e15;
    if (factor < 0 || value < 0 || value * factor > most)
      fail(ErrorCode::bad_argument, place, ": ", text,
           " is not a time (a number with ns, us, ms or s)");
    return Time(std::llround(value * factor));
  }
  [[nodiscard]] double rate() const {
    std::string_view unit;
    const double value = number(&unit);
    const double factor = unit == "GB/s" ? 1e9 : unit == "MB/s" ? 1e6 : -1;
    const double rate = value * factor;
    if (!(rate >= 1 && rate <= 1e18))
      fail(ErrorCode::bad_argument, place, ": ", text,
           " is not a rate (a number with MB/s or GB/s, from a byte to 1e9 GB a second)");
    return rate;
  }
  [[nodiscard]] std::int64_t whole(std::int64_t least, std::int64_t most) const {
    std::string_view unit;
    const double value = number(&unit);
    if (!unit.empty() || value < static_cast<double>(least) || value > static_cast<double>(most) ||
        value != std::floor(value))
      fail(ErrorCode::bad_argument, place, ": ", text, " is not a whole number of ", least, " … ",
           most);
    return static_cast<std::int64_t>(value);
  }
  /// "1..200".
  void take_range(SeedRange& seeds) const {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos)
      fail(ErrorCode::bad_argument, place, ": ", text, " is no range such as 1..200");
    const Value first{place, text.substr(0, dots)}, last{place, text.substr(dots + 2)};
    const std::int64_t least = first.whole(0, most_seed);
    seeds.first = static_cast<std::uint64_t>(least);
    seeds.last = static_cast<std::uint64_t>(last.whole(least, most_seed));
  }
  [[nodiscard]] double probability() const {
    std::string_view unit;
    const double value = number(&unit);
    if (!unit.empty() || value < 0 || value > 1)
      fail(ErrorCode::bad_argument, place, ": ", text, " is not a probability of 0 … 1");
    return value;
  }
};

constexpr const char* machine_keys =
    "latency, bandwidth, overhead, process-latency, process-bandwidth, process-overhead, "
    "process-copy";

/// The keys of the machine, which a file may have; false for another key.
bool take_of_machine(const std::string& key, const Value& value, SimulatedOptions& options) {
  if (key == "latency") {
    options.latency = value.time();
  } else if (key == "bandwidth") {
    options.bandwidth = value.rate();
  } else if (key == "overhead") {
    options.overhead = value.time();
  } else if (key == "process-latency") {
    options.process_latency = value.time();
  } else if (key == "process-bandwidth") {
    options.process_bandwidth = value.rate();
  } else if (key == "process-overhead") {
    options.process_overhead = value.time();
  } else if (key == "process-copy") {
    options.process_copy = value.rate();
  } else {
    return false;
  }
  return true;
}

/// The keys of a run; false for another key.
bool take_of_run(const std::string& key, const Value& value, SimulatedOptions& options) {
  if (key == "pes") {
    options.n_pes = static_cast<std::int32_t>(value.whole(1, 1 << 20));
  } else if (key == "per-process") {
    options.pes_per_process = static_cast<std::int32_t>(value.whole(1, 1 << 20));
  } else if (key == "seed") {
    options.seed = static_cast<std::uint64_t>(value.whole(0, most_seed));
  } else if (key == "seeds" || key == "compare") {
    if (!options.seeds) options.seeds.emplace();
    if (key == "seeds") value.take_range(*options.seeds);
    if (key == "compare") options.seeds->compare = value.text;
  } else if (key == "cost") {
    options.cost.reset();
    if (value.text != "measured") options.cost = value.time();
  } else if (key == "migrate") {
    options.migration_chance = value.probability();
  } else {
    return false;
  }
  return true;
}

std::string without_spaces(const std::string& text) {
  const char* const spaces = " \t\r";
  const std::size_t begin = text.find_first_not_of(spaces);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(spaces) - begin + 1);
}

}  // namespace

void read_simulated_file(const std::string& path, SimulatedOptions& options) {
  std::ifstream file(path);
  if (!file)
    fail(ErrorCode::bad_file, "--sim: the file ", path,
         " cannot be opened: give key=value, or a file that bench --calibrate wrote");
  std::size_t number = 0, n_values = 0;
  for (std::string line; std::getline(file, line);) {
    if (++number == 1) line = detail::without_byte_order_mark(line);
    line = without_spaces(line);
    if (line.empty() || line.front() == '#') continue;
    const std::string place = text(path, ":", number, ": ");
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
      fail(ErrorCode::bad_file, place, line,
           " is not of the form key=value: write the file with bench --calibrate");
    const std::string key = without_spaces(line.substr(0, equals));
    const Value value{place + key, without_spaces(line.substr(equals + 1))};
    if (!take_of_machine(key, value, options))
      fail(ErrorCode::bad_file, place, "unknown key ", key, ": a file has ", machine_keys,
           "; give others as --sim ", path, ",", line);
    ++n_values;
  }
  if (file.bad() || n_values == 0)
    fail(ErrorCode::bad_file, "--sim: the file ", path,
         " has no values: write it with bench --calibrate ", path);
}

SimulatedOptions parse_simulated(const std::string& given) {
  SimulatedOptions options;
  options.watches_cost = true;
  std::size_t at = 0;
  while (at < given.size()) {
    const std::size_t comma = std::min(given.find(',', at), given.size());
    const std::string part = given.substr(at, comma - at);
    at = comma + 1;
    const std::size_t equals = part.find('=');
    const std::string key = equals == std::string::npos ? "file" : part.substr(0, equals);
    const std::string keys =
        std::string("pes, per-process, cost, seed, seeds, compare, migrate, file, ") + machine_keys;
    const Value value{"--sim " + key, equals == std::string::npos ? part : part.substr(equals + 1)};
    if (key == "file") {
      read_simulated_file(value.text, options);
    } else if (!take_of_machine(key, value, options) && !take_of_run(key, value, options)) {
      fail(ErrorCode::bad_argument, "--sim: unknown key ", key, " (", keys, ")",
           did_you_mean(key, keys));
    }
  }
  if (options.seeds && options.seeds->first > options.seeds->last)
    fail(ErrorCode::bad_argument, "--sim compare: ", options.seeds->compare,
         " is for seeds=FIRST..LAST, which is missing");
  if (options.seeds && options.seed)
    fail(ErrorCode::bad_argument, "--sim seed: ", *options.seed,
         " is one of many beside seeds=FIRST..LAST; leave it out");
  if (options.pes_per_process != 0 && options.n_pes % options.pes_per_process != 0)
    fail(ErrorCode::bad_argument, "--sim: ", options.n_pes, " PEs do not divide into processes of ",
         options.pes_per_process);
  return options;
}

double migration_chance(const SimulatedOptions& options) {
  if (options.migration_chance) return *options.migration_chance;
  if (!options.seed) return 0;
  constexpr std::array<double, 4> choices{0, 0.01, 0.1, 0.5};
  return choices[mix(*options.seed ^ 0x6d696772U) % 4];
}

}  // namespace tess::detail
