// A range of seeds on the command line.
#pragma once

#include <cstdint>
#include <string>

namespace kit {

struct Seeds {
  std::uint64_t first = 0, last = 0;
};

/// "FROM:TO", both included and less than 2^64 - 1, or one seed. Throws tess::Error (bad_argument)
/// otherwise.
[[nodiscard]] Seeds parse_seeds(const std::string& given);

}  // namespace kit
