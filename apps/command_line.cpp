#include "apps/command_line.hpp"

#include "runtime/machine/mpi.hpp"

#include <CLI/CLI.hpp>
#include <optional>

namespace apps {

Option& Option::between(std::int64_t least, std::int64_t most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::positive() {
  option_->check([](const std::string& value) {
    double number = 0;
    return CLI::detail::lexical_cast(value, number) && number > 0
               ? std::string()
               : value + " is not a number above 0";
  });
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return *this;
}

Option& Option::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::takes(int least, int most) {
  option_->expected(least, most);
  return *this;
}

bool Option::is_given() const {
  return option_->count() != 0;
}

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : app_(std::make_unique<CLI::App>(description, program)) {}

CommandLine::~CommandLine() = default;

template <class T>
Option CommandLine::option(const std::string& name, T& value, const std::string& meaning) {
  CLI::Option* const option = app_->add_option(name, value, meaning);
  // What follows "--fields sin" is the first of the arguments without a name, not a second field.
  if (name.starts_with("-")) option->allow_extra_args(false);
  return Option(option);
}

Option CommandLine::flag(const std::string& name, bool& value, const std::string& meaning) {
  return Option(app_->add_flag(name, value, meaning));
}

bool CommandLine::parse(int argc, char** argv, const std::string& footer) {
  app_->footer(footer);
  try {
    app_->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    if (tess::speaks_for_job()) tess::print(app_->help());
    return false;
  } catch (const CLI::ParseError& error) {
    tess::fail(tess::ErrorCode::bad_argument, error.what(), " (--help lists the options)");
  }
  return true;
}

bool CommandLine::is_given(const std::string& name) const {
  const CLI::Option* const option = app_->get_option_no_throw(name);
  return option != nullptr && option->count() != 0;
}

std::string CommandLine::value(const std::string& name) const {
  CLI::Option* const option = app_->get_option(name);
  if (option->get_items_expected_max() == 0) return is_given(name) ? "yes" : "no";  // a flag
  option->capture_default_str();  // reads the variable
  std::string text = option->get_default_str();
  std::erase_if(text, [](char c) { return c == '[' || c == ']'; });  // around several values
  return text;
}

void refuse_together(std::string_view option, std::string_view other) {
  tess::fail(tess::ErrorCode::bad_argument, option, " does not work with ", other,
             "; leave one of them out");
}

template Option CommandLine::option(const std::string&, std::int32_t&, const std::string&);
template Option CommandLine::option(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::option(const std::string&, double&, const std::string&);
template Option CommandLine::option(const std::string&, std::string&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<std::int32_t>&,
                                    const std::string&);
template Option CommandLine::option(const std::string&, std::optional<std::uint64_t>&,
                                    const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::int32_t>&,
                                    const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::uint64_t>&,
                                    const std::string&);
template Option CommandLine::option(const std::string&, std::vector<double>&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::string>&,
                                    const std::string&);

}  // namespace apps
