// The text of --help, in the layout of the runtime's own options: the option and what it takes,
// then its meaning from column 14 on, with its range and its default, at most 100 columns wide.
//
//   --steps N   applications of all pairs, with the donors of one search (default 1)
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace apps {

/// Reads what an option takes from its type name, and its range from the descriptions of its
/// checks.
class HelpText : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
};

/// The default of an option as text; empty if it has none. A vector is "a,b".
[[nodiscard]] std::string default_of(const CLI::Option& option);

}  // namespace apps
