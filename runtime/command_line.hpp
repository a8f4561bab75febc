// A program's own options, read after the runtime has taken its options out of the command line.
//
//     int main(int argc, char** argv) {
//       return tess::guarded(argc, argv, [&](tess::Setup& setup) {
//         std::int32_t n_steps = 10;
//         tess::CommandLine line("Heats a plate.");
//         line.option("--steps", n_steps, "time steps").between(1, 1'000'000);
//         if (!line.parse(argc, argv)) return 0;
//         return tess::run(setup, [=] { … });
//       });
//     }
//
// parse() throws tess::Error for what is wrong, which guarded() prints in one line. --help lists
// the program's options, --help-runtime the runtime's; --version says which build it is. A user
// writes "--steps 5" or "--steps=5"; after "--" no word is an option. The CMake target is
// Tessera::command_line.
#pragma once

#include "runtime/run.hpp"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tess {

namespace detail {
struct OptionAccess;
struct OptionState;
}  // namespace detail

/// An option of a CommandLine, for what there is to say beyond its name. It refers to the
/// CommandLine.
class Option {
 public:
  /// Both bounds are included; a variable that is a double takes any number between.
  Option& between(std::int64_t least, std::int64_t most);
  Option& positive();
  Option& one_of(const std::vector<std::string>& values);
  /// "a,b,c" are three values.
  Option& separated_by(char separator);
  /// If the option is given several times, the values become one, with this between them.
  Option& joined_by(char separator);
  /// The number of values that follow the name. What is above `least` must not look like an option.
  Option& takes(int least, int most);
  /// It is known once the line is parsed.
  [[nodiscard]] bool is_given() const;

 private:
  friend class CommandLine;
  explicit Option(detail::OptionState& state) : state_(&state) {}
  detail::OptionState* state_;
};

class CommandLine {
 public:
  explicit CommandLine(std::string description);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The options that follow stand below this heading in the help; before the first call below
  /// "Options".
  void group(const std::string& heading) { group_ = heading; }

  /// `name` is "--name", "-n,--name", "--name FILE" if the help should call the value so, or "NAME"
  /// for an argument that is known by its place. `value` holds the default, and parse() assigns
  /// what is given; it must outlive the CommandLine. T is std::int32_t, std::uint64_t, double,
  /// std::string, a vector of one of these, or an optional of one of the integers. Of several
  /// values the last counts; a vector takes one value each time that its "--name" is given, and as
  /// an argument all that remain. The help adds the default unless `meaning` has the word.
  template <class T>
  Option option(const std::string& name, T& value, const std::string& meaning);
  Option flag(const std::string& name, bool& value, const std::string& meaning);

  /// More text for the help, below the options.
  void footer(const std::string& text) { footer_ += "\n" + text; }
  /// Commands for the help that show what the program does: the words after its name.
  void examples(std::initializer_list<const char*> commands) { examples_ = commands; }

  /// False if it printed the help or the version: the program is done. Throws tess::Error for bad
  /// options. `runtime_help` is empty for a program that takes no options of the runtime.
  [[nodiscard]] bool parse(int argc, char** argv, const std::string& runtime_help = options_help());

  /// The text of --help.
  [[nodiscard]] std::string help() const;

  /// It is known once the line is parsed; false for a name that is no option.
  [[nodiscard]] bool is_given(const std::string& name) const;
  /// Throws tess::Error (bad_argument) if one of the options is given, since it needs `what`.
  void refuse_without(const std::string& what, std::initializer_list<const char*> names) const;
  /// Throws refuse_together() if one of the options is given, since `other` leaves it unused; the
  /// message has its value.
  void refuse_beside(const std::string& other, std::initializer_list<const char*> names) const;
  /// The value of an option as text, whether it is given or the default: equal for equal values,
  /// and for no others.
  [[nodiscard]] std::string value(const std::string& name) const;

 private:
  Option add(const std::string& name, void* variable, const detail::OptionAccess& access,
             const std::string& meaning);
  [[nodiscard]] detail::OptionState* find(std::string_view name) const;
  /// Refuses a name that is no option, with the nearest one.
  [[nodiscard]] detail::OptionState& known(const std::string& name) const;
  void take_argument(const std::string& word);
  /// Takes the values that `word` holds and that follow it; returns how many of `next` they are.
  std::size_t take_option(detail::OptionState& option, const std::string& word,
                          std::span<const std::string> next) const;

  std::string description_, program_, footer_, runtime_help_;
  std::vector<const char*> examples_;
  std::string group_ = "Options";
  bool asks_ = false;
  std::vector<std::unique_ptr<detail::OptionState>> options_;
};

/// Throws tess::Error (bad_argument): two options are given of which each works only without the
/// other. Both are written as they were given: "--steps 5".
[[noreturn]] void refuse_together(std::string_view option, std::string_view other);

}  // namespace tess
