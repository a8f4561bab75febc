#include "runtime/command_line.hpp"

#include "runtime/base/option_state.hpp"
#include "runtime/base/option_words.hpp"
#include "runtime/core/check.hpp"
#include "runtime/version.hpp"
#include "runtime/wire/machine/mpi.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace tess {

using detail::looks_like_option, detail::name_in;
using detail::OptionAccess, detail::OptionState, detail::Texts, detail::refuse;

namespace {
constexpr int unlimited = std::numeric_limits<int>::max();
}  // namespace

Option& Option::between(std::int64_t least, std::int64_t most) {
  state_->range = {least, most};
  return *this;
}

Option& Option::positive() {
  state_->is_positive = true;
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& values) {
  state_->choices = values;
  state_->placeholder = detail::join(values, '|');
  return *this;
}

Option& Option::separated_by(char separator) {
  state_->separator = separator;
  return *this;
}

Option& Option::joined_by(char separator) {
  state_->joint = separator;
  state_->most = unlimited;
  return *this;
}

Option& Option::takes(int least, int most) {
  state_->least = least;
  state_->most_each = state_->most = most;
  return *this;
}

bool Option::is_given() const {
  return state_->is_given;
}

CommandLine::CommandLine(std::string description) : description_(std::move(description)) {
  flag("-h,--help", asks_, "print this text");
  flag("--version", asks_, "print the version, the commit, the compiler and MPI");
  flag("--help-runtime", asks_, "print the runtime's options: --pes, --sim, --stats and others");
}

CommandLine::~CommandLine() = default;

template <class T>
Option CommandLine::option(const std::string& name, T& value, const std::string& meaning) {
  return add(name, &value, detail::access_to<T>(), meaning);
}

Option CommandLine::flag(const std::string& name, bool& value, const std::string& meaning) {
  return add(name, &value, detail::access_to<bool>(), meaning).takes(0, 0);
}

Option CommandLine::add(const std::string& name, void* variable, const OptionAccess& access,
                        const std::string& meaning) {
  const std::size_t space = name.find(' ');
  const Texts names = detail::split(name.substr(0, space), ',');
  for (const std::string& one : names)
    TESS_CHECK(find(one) == nullptr, "the program has two options ", one);
  OptionState& option = *options_.emplace_back(std::make_unique<OptionState>());
  option.names = names;
  option.placeholder = space == std::string::npos ? access.placeholder : name.substr(space + 1);
  option.meaning = meaning;
  option.heading = name.starts_with('-') ? group_ : "Arguments";
  option.access = access;
  option.variable = variable;
  option.most = access.is_list ? unlimited : 1;
  return Option(option);
}

bool CommandLine::parse(int argc, char** argv, const std::string& runtime_help) {
  const std::string_view path = argv[0];
  program_ = path.substr(path.rfind('/') + 1);
  runtime_help_ = runtime_help;
  if (runtime_help.empty())
    std::erase_if(options_, [](const auto& o) { return o->names.front() == "--help-runtime"; });
  for (const auto& option : options_) {
    option->is_given = false;
    option->values.clear();
  }
  const Texts words(argv + 1, argv + argc);
  bool options_ended = false;
  for (std::size_t i = 0; i < words.size();) {
    const std::string& word = words[i++];
    if (options_ended || !looks_like_option(word)) {
      take_argument(word);
    } else if (word == "--") {
      options_ended = true;
    } else if (OptionState& option = known(name_in(word)); option.variable != &asks_) {
      i += take_option(option, word, std::span(words).subspan(i));
    } else {
      const std::string& name = option.names.back();
      if (detail::speaks_for_job())
        print(name == "--help"      ? help()
              : name == "--version" ? version_text(program_)
                                    : runtime_help_);
      return false;
    }
  }
  for (const auto& option : options_)
    if (option->is_given) option->assign();
  detail::words_are_read();
  return true;
}

void CommandLine::take_argument(const std::string& word) {
  for (const auto& option : options_)
    if (option->is_argument() && option->n_values() < option->most) {
      option->is_given = true;
      option->add(word);
      return;
    }
  refuse(text("argument '", word, "' is one too many; leave it out"));
}

std::size_t CommandLine::take_option(detail::OptionState& option, const std::string& word,
                                     std::span<const std::string> next) const {
  const std::string name = name_in(word);
  option.is_given = true;
  if (option.most <= 1) option.values.clear();  // the last one counts
  const int n_before = option.n_values();
  if (name.size() < word.size()) {
    if (option.most_each == 0)
      refuse(text(name, " takes no value; leave out ", word.substr(name.size())));
    option.add(word.substr(name.size() + 1));
  }
  std::size_t n_taken = 0;
  for (; n_taken < next.size() && option.n_values() - n_before < option.most_each; ++n_taken) {
    const std::string& value = next[n_taken];
    // A value that is needed may begin with '-'.
    const bool is_needed = option.n_values() - n_before < option.least;
    if (is_needed ? value == "--" || find(name_in(value)) != nullptr : looks_like_option(value))
      break;
    option.add(value);
  }
  if (option.least > 0 && option.n_values() == n_before) refuse(name + " needs a value");
  return n_taken;
}

std::string CommandLine::help() const {
  std::string out =
      text(description_, "\nUsage: ", program_, program_.empty() ? "" : " ", "[OPTIONS]");
  Texts headings{"Arguments"};
  for (const auto& option : options_) {
    if (option->is_argument())
      out += text(" [", option->names.front(), option->most == unlimited ? "...]" : "]");
    if (std::count(headings.begin(), headings.end(), option->heading) == 0)
      headings.push_back(option->heading);
  }
  out += '\n';
  for (const std::string& heading : headings) {
    std::string lines;
    for (const auto& option : options_)
      if (option->heading == heading) lines += option->help();
    if (!lines.empty()) out += text("\n", heading, ":\n", lines);
  }
  if (!examples_.empty()) out += "\nExamples:\n";
  for (const char* const example : examples_) out += text("  ", program_, " ", example, "\n");
  return out + footer_;
}

detail::OptionState* CommandLine::find(std::string_view name) const {
  for (const auto& option : options_)
    if (std::count(option->names.begin(), option->names.end(), name) != 0) return option.get();
  return nullptr;
}

detail::OptionState& CommandLine::known(const std::string& name) const {
  if (OptionState* const option = find(name)) return *option;
  detail::refuse_unknown_option(name, help() + runtime_help_);  // with options of the footer
}

bool CommandLine::is_given(const std::string& name) const {
  const OptionState* const option = find(name);
  return option != nullptr && option->is_given;
}

void CommandLine::refuse_without(const std::string& what,
                                 std::initializer_list<const char*> names) const {
  for (const char* name : names)
    if (is_given(name))
      fail(ErrorCode::bad_argument, name, ": needs ", what, "; give one, or leave it out");
}

void CommandLine::refuse_beside(const std::string& other,
                                std::initializer_list<const char*> names) const {
  for (const char* name : names) {
    if (!is_given(name)) continue;
    const std::string values = detail::join(find(name)->values, ',');
    refuse_together(text(name, values.empty() ? "" : " ", values), other);
  }
}

std::string CommandLine::value(const std::string& name) const {
  const OptionState* const option = find(name);
  TESS_CHECK(option != nullptr, "value(): the program has no option ", name);
  return option->access.text(option->variable);
}

void refuse_together(std::string_view option, std::string_view other) {
  fail(ErrorCode::bad_argument, option, " does not work with ", other, "; leave one of them out");
}

using Text = const std::string&;
template Option CommandLine::option(Text, std::int32_t&, Text);
template Option CommandLine::option(Text, std::uint64_t&, Text);
template Option CommandLine::option(Text, double&, Text);
template Option CommandLine::option(Text, std::string&, Text);
template Option CommandLine::option(Text, std::optional<std::int32_t>&, Text);
template Option CommandLine::option(Text, std::optional<std::uint64_t>&, Text);
template Option CommandLine::option(Text, std::vector<std::int32_t>&, Text);
template Option CommandLine::option(Text, std::vector<std::uint64_t>&, Text);
template Option CommandLine::option(Text, std::vector<double>&, Text);
template Option CommandLine::option(Text, std::vector<std::string>&, Text);

}  // namespace tess
