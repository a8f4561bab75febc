#include "runtime/more/testing/trial.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/core.h>

namespace tess::test::detail {
namespace {

constexpr std::string_view seed_key = "seed=", keep_key = "keep=";
thread_local Trial* the_trial = nullptr;

template <class Number>
Number number_of(std::string_view part, std::string_view text, int base) {
  const auto number = parse_number<Number>(text, base);
  if (!number)
    fail(ErrorCode::bad_argument, "TESS_TEST_REPEAT: ", part, " ", text,
         " is no number; it is of the form seed=17 or seed=17,keep=2f61b6e8,00a1b2c3");
  return *number;
}

}  // namespace

Repeat parse_repeat(std::string_view given) {
  if (!given.starts_with(seed_key))
    fail(ErrorCode::bad_argument, "TESS_TEST_REPEAT: ", given,
         " does not begin with seed=, for example seed=17,keep=2f61b6e8");
  const std::size_t comma = std::min(given.find(','), given.size());
  Repeat repeat;
  repeat.seed =
      number_of<std::uint64_t>("seed", given.substr(seed_key.size(), comma - seed_key.size()), 10);
  if (comma == given.size()) return repeat;
  std::string_view rest = given.substr(comma + 1);
  if (!rest.starts_with(keep_key))
    fail(ErrorCode::bad_argument, "TESS_TEST_REPEAT: ", rest, " does not begin with keep=");
  rest.remove_prefix(keep_key.size());
  repeat.keep.emplace();
  if (rest == "none") return repeat;
  while (true) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    repeat.keep->push_back(number_of<DecisionId>("decision", rest.substr(0, end), 16));
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  std::sort(repeat.keep->begin(), repeat.keep->end());
  return repeat;
}

std::string repeat_text(const Repeat& repeat) {
  std::string out = fmt::format("{}{}", seed_key, repeat.seed);
  if (!repeat.keep) return out;
  out += "," + std::string(keep_key);
  if (repeat.keep->empty()) return out + "none";
  for (std::size_t i = 0; i < repeat.keep->size(); ++i)
    out += fmt::format("{}{:08x}", i == 0 ? "" : ",", (*repeat.keep)[i]);
  return out;
}

std::optional<Repeat> requested_repeat() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): called between runs, which have one thread
  const char* requested = std::getenv("TESS_TEST_REPEAT");
  if (requested == nullptr || *requested == '\0') return std::nullopt;
  return parse_repeat(requested);
}

Trial* current_trial() {
  return the_trial;
}

InTrial::InTrial(Trial& trial) : before_(the_trial) {
  the_trial = &trial;
}
InTrial::~InTrial() {
  the_trial = before_;
}

}  // namespace tess::test::detail
