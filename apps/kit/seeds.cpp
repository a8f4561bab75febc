#include "apps/kit/seeds.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <limits>

namespace kit {

Seeds parse_seeds(const std::string& given) {
  const std::size_t colon = given.find(':');
  const auto number = [&](std::size_t from, std::size_t to) {
    const auto value =
        tess::parse_number<std::uint64_t>(std::string_view(given).substr(from, to - from));
    if (!value)
      tess::fail(tess::ErrorCode::bad_argument, "--seeds: ", given, " is not of the form FROM:TO");
    if (*value == std::numeric_limits<std::uint64_t>::max())  // a loop over it would not end
      tess::fail(tess::ErrorCode::bad_argument, "--seeds: ", given, ": seeds are less than ",
                 *value);
    return *value;
  };
  if (colon == std::string::npos) return {number(0, given.size()), number(0, given.size())};
  const Seeds seeds{number(0, colon), number(colon + 1, given.size())};
  if (seeds.last < seeds.first)
    tess::fail(tess::ErrorCode::bad_argument, "--seeds: ", given, " ends before it begins");
  return seeds;
}

}  // namespace kit
