// A program's own options, after tess::take_options() has taken the runtime's: one line and exit 2
// for what is wrong (tess::guarded), --help with the runtime's options below the program's. CLI11
// reads them; it is compiled here and not in every program.
#pragma once

#include "runtime/run.hpp"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace apps {

/// An option of a CommandLine, for what there is to say beyond its name.
class Option {
 public:
  /// Both included; a variable that is a double takes any number between.
  Option& between(std::int64_t least, std::int64_t most);
  Option& positive();
  Option& one_of(const std::vector<std::string>& values);
  /// "a,b,c" are three values.
  Option& separated_by(char separator);
  /// Given several times, the values are one, with this between them.
  Option& joined_by(char separator);
  /// So many values follow.
  Option& takes(int least, int most);
  /// Known once the line is parsed.
  [[nodiscard]] bool is_given() const;

 private:
  friend class CommandLine;
  Option(CLI::Option* option, bool is_real) : option_(option), is_real_(is_real) {}
  CLI::Option* option_;
  bool is_real_;
};

class CommandLine {
 public:
  explicit CommandLine(const std::string& description);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The options that follow stand below this heading in the help; before the first call below
  /// "Options".
  void group(const std::string& heading) { group_ = heading; }

  /// "--name", "--name FILE" if the help should call what it takes so, or "NAME" by its place;
  /// `value` is the default and takes what is given. T: integers of 32 and 64 bits, double,
  /// std::string, and vectors or optionals of some of them. A vector takes one value each time that
  /// its "--name" is given; see also separated_by(). The help adds the default unless `meaning` has
  /// the word.
  template <class T>
  Option option(const std::string& name, T& value, const std::string& meaning);
  Option flag(const std::string& name, bool& value, const std::string& meaning);

  /// False if it printed the help, `footer` below it: the program is done. Throws tess::Error for
  /// bad options.
  [[nodiscard]] bool parse(int argc, char** argv, const std::string& footer = tess::options_help());

  /// The text of --help; with the footer once the line is parsed.
  [[nodiscard]] std::string help() const;

  /// Known once the line is parsed. False for a name that is no option.
  [[nodiscard]] bool is_given(const std::string& name) const;
  /// Throws tess::Error (bad_argument) if one of the options is given, since it needs `what`.
  void refuse_without(const std::string& what, std::initializer_list<const char*> names) const;
  /// Throws refuse_together() if one of the options is given, since `other` leaves it unused; the
  /// message has its value.
  void refuse_beside(const std::string& other, std::initializer_list<const char*> names) const;
  /// The value of an option as text, whether it is given or the default: equal for equal values, and
  /// for no others.
  [[nodiscard]] std::string value(const std::string& name) const;

 private:
  /// An option as it was given: "--steps 5", or "--check", a flag.
  [[nodiscard]] std::string as_given(const std::string& name) const;

  std::unique_ptr<CLI::App> app_;
  std::string group_ = "Options";
};

/// Throws tess::Error (bad_argument): two options are given of which each works only without the
/// other. Both as they were given: "--steps 5".
[[noreturn]] void refuse_together(std::string_view option, std::string_view other);

}  // namespace apps
