#include "runtime/base/words.hpp"

#include <charconv>
#include <cstdlib>
#include <string>

namespace tess::detail {

bool to_number(std::string_view word, double& to) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, to);
  if (stop != end || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) to = std::strtod(std::string(word).c_str(), nullptr);
  return true;
}

}  // namespace tess::detail
