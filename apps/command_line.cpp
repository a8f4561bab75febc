#include "apps/command_line.hpp"

#include "apps/help_text.hpp"
#include "runtime/machine/mpi.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <type_traits>

namespace apps {
namespace {

/// A range that ends above this is no news to a reader of the help.
constexpr std::int64_t most_to_mention = 100'000;

/// What an option takes where its name does not say it.
template <class T>
constexpr const char* placeholder() {
  if constexpr (std::is_integral_v<T>) {
    return "N";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "X";
  } else if constexpr (requires { typename T::value_type; } && !std::is_same_v<T, std::string>) {
    return placeholder<typename T::value_type>();  // a vector or an optional
  } else {
    return "TEXT";
  }
}

/// What an option takes, one of it.
template <class T>
struct OneOf {
  using type = T;
};
template <class T>
struct OneOf<std::optional<T>> : OneOf<T> {};
template <class T>
struct OneOf<std::vector<T>> : OneOf<T> {};

/// CLI11 prints six digits, with which values that differ may look equal.
std::string all_digits(double value) {
  return fmt::format("{}", value);
}
std::string all_digits(const std::vector<double>& values) {
  return fmt::format("{}", fmt::join(values, ","));
}

/// CLI11 takes -1 for 2^64 - 1, and so what is larger.
std::string fits_unsigned(const std::string& value) {
  errno = 0;
  (void)std::strtoull(value.c_str(), nullptr, 10);
  return value.find('-') != std::string::npos || errno == ERANGE
             ? value + " is not a whole number from 0 to 18446744073709551615"
             : std::string();
}

/// CLI11 takes 010 for 8.
std::string is_decimal(const std::string& value) {
  const std::size_t first = value.find_first_not_of(" +-");
  return first != std::string::npos && first + 1 < value.size() && value[first] == '0'
             ? value + " begins with a zero; write it as a decimal number"
             : std::string();
}

}  // namespace

Option& Option::between(std::int64_t least, std::int64_t most) {
  std::string range;
  if (most <= most_to_mention) range = ' ' + std::to_string(least) + " to " + std::to_string(most);
  if (!is_real_) {
    option_->check(CLI::Range(least, most).description(range));
    return *this;
  }
  const auto refusal = [least, most](const std::string& value) {
    double number = 0;
    return CLI::detail::lexical_cast(value, number) && number >= static_cast<double>(least) &&
                   number <= static_cast<double>(most)
               ? std::string()
               : "Value " + value + " not in range " + std::to_string(least) + " to " +
                     std::to_string(most);
  };
  option_->check(refusal, range);
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
  option_->check(CLI::IsMember(values).description(""));
  option_->type_name(CLI::detail::join(values, "|"));
  return *this;
}

Option& Option::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::joined_by(char separator) {
  option_->join(separator);
  return *this;
}

Option& Option::takes(int least, int most) {
  option_->expected(least, most);
  return *this;
}

bool Option::is_given() const {
  return option_->count() != 0;
}

CommandLine::CommandLine(const std::string& description)
    : app_(std::make_unique<CLI::App>(description)) {
  app_->formatter(std::make_shared<HelpText>());
  app_->set_help_flag("-h,--help", "print this text");
}

CommandLine::~CommandLine() = default;

template <class T>
Option CommandLine::option(const std::string& name, T& value, const std::string& meaning) {
  const std::size_t space = name.find(' ');
  CLI::Option* const option = app_->add_option(name.substr(0, space), value, meaning);
  option->type_name(space == std::string::npos ? placeholder<T>() : name.substr(space + 1));
  option->group(group_);
  if constexpr (std::is_floating_point_v<typename OneOf<T>::type>)
    option->default_function([&value] { return all_digits(value); });
  option->capture_default_str();
  if constexpr (std::is_same_v<typename OneOf<T>::type, std::uint64_t>)
    option->check(fits_unsigned, "");
  if constexpr (std::is_integral_v<typename OneOf<T>::type>) option->check(is_decimal, "");
  // What follows "--fields sin" is the first of the arguments without a name, not a second field.
  if (name.starts_with("-")) option->allow_extra_args(false);
  // As for the runtime's options: the last value counts.
  if (name.starts_with("-") && option->get_items_expected_max() == 1)
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  return {option, std::is_floating_point_v<typename OneOf<T>::type>};
}

Option CommandLine::flag(const std::string& name, bool& value, const std::string& meaning) {
  CLI::Option* const option = app_->add_flag(name, value, meaning);
  option->group(group_);
  return {option, false};
}

bool CommandLine::parse(int argc, char** argv, const std::string& footer) {
  app_->footer(footer);
  app_->name(std::filesystem::path(argv[0]).filename().string());
  try {
    app_->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    if (tess::speaks_for_job()) tess::print(help());
    return false;
  } catch (const CLI::ParseError& error) {
    tess::fail(tess::ErrorCode::bad_argument, error.what(), " (--help lists the options)");
  }
  return true;
}

std::string CommandLine::help() const {
  return app_->help();
}

bool CommandLine::is_given(const std::string& name) const {
  const CLI::Option* const option = app_->get_option_no_throw(name);
  return option != nullptr && option->count() != 0;
}

void CommandLine::refuse_without(const std::string& what,
                                 std::initializer_list<const char*> names) const {
  for (const char* name : names)
    if (is_given(name))
      tess::fail(tess::ErrorCode::bad_argument, name, ": needs ", what,
                 "; give one, or leave it out");
}

void CommandLine::refuse_beside(const std::string& other,
                                std::initializer_list<const char*> names) const {
  for (const char* name : names)
    if (is_given(name)) refuse_together(as_given(name), other);
}

std::string CommandLine::as_given(const std::string& name) const {
  const CLI::Option* const option = app_->get_option(name);
  if (option->get_items_expected_max() == 0) return name;  // a flag
  const std::string values = fmt::format("{}", fmt::join(option->reduced_results(), ","));
  return values.empty() ? name : name + ' ' + values;
}

std::string CommandLine::value(const std::string& name) const {
  CLI::Option* const option = app_->get_option(name);
  if (option->get_items_expected_max() == 0) return is_given(name) ? "yes" : "no";  // a flag
  option->capture_default_str();  // reads the variable
  return default_of(*option);
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
