// An option of a command line: its name and meaning, its variable, and the values that are given.
// The parser beside it takes words for its values; here they are checked and assigned.
#pragma once

#include "runtime/base/option_access.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tess::detail {

struct OptionState {
  [[nodiscard]] bool is_argument() const { return !names.front().starts_with('-'); }
  [[nodiscard]] int n_values() const { return static_cast<int>(values.size()); }
  /// Adds a word of the command line to the values.
  void add(const std::string& word);
  /// Assigns the values to the variable. Throws tess::Error for values that the option does not take.
  void assign();
  /// Its entry in the help.
  [[nodiscard]] std::string help() const;

  Texts names{};
  std::string placeholder{}, meaning{}, heading{};
  OptionAccess access{};
  void* variable = nullptr;
  int most = 1;                  ///< values in all
  int least = 1, most_each = 1;  ///< values each time that the name is given
  char separator = 0, joint = 0;
  std::optional<std::pair<std::int64_t, std::int64_t>> range{};
  bool is_positive = false;
  Texts choices{};
  bool is_given = false;
  Texts values{};
};

[[nodiscard]] std::string join(const Texts& texts, char separator);
/// The parts of a text that are not empty.
[[nodiscard]] Texts split(std::string_view text, char separator);

/// Throws tess::Error for a command line.
[[noreturn]] void refuse(const std::string& message);

}  // namespace tess::detail
