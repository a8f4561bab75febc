#include "runtime/base/option_state.hpp"

#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

constexpr std::int64_t most_to_mention = 100'000;  // a range up to more is no news in the help
constexpr std::size_t meaning_column = 14, most_columns = 100;

/// Why the option does not take a value; empty if it does.
std::string refusal(const OptionState& option, const std::string& value) {
  const OptionAccess& access = option.access;
  const std::size_t digit = value.starts_with('-') ? 1 : 0;
  if (access.is_whole && digit + 1 < value.size() && value[digit] == '0')
    return value + " begins with a zero; write it as a decimal number";
  const std::string shown = value.empty() ? "''" : value;
  const auto number = access.number != nullptr ? access.number(value) : std::nullopt;
  if (option.range) {
    const auto [least, most] = *option.range;
    const bool is_inside = number && *number >= static_cast<long double>(least) &&
                           *number <= static_cast<long double>(most);
    if (!is_inside) return text("Value ", shown, " not in range ", least, " to ", most);
  }
  if (option.is_positive && !(number && *number > 0)) return shown + " is not a number above 0";
  const Texts& choices = option.choices;
  if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end())
    return text(shown, " not in {", join(choices, ','), "}",
                did_you_mean(value, join(choices, ',')));
  if (access.number != nullptr && !number) return shown + " is not " + access.what;
  return {};
}

}  // namespace

void OptionState::add(const std::string& word) {
  if (separator == 0 || word.find(separator) == std::string::npos) return values.push_back(word);
  const Texts parts = split(word, separator);
  values.insert(values.end(), parts.begin(), parts.end());
}

void OptionState::assign() {
  const std::string& name = names.back();
  const bool is_too_few = n_values() < least;
  if (is_too_few || n_values() > most)
    refuse(text(name, ": takes ",
                least == most ? ""
                : is_too_few  ? "at least "
                              : "at most ",
                is_too_few ? least : most, " values, not ", n_values()));
  for (const std::string& value : values)
    if (const std::string why = refusal(*this, value); !why.empty()) refuse(text(name, ": ", why));
  if (joint != 0) values = {join(values, joint)};
  access.assign(variable, values);
}

std::string OptionState::help() const {
  const std::string margin(meaning_column, ' ');
  std::string out = "  " + join(names, ',');
  if (is_argument() && most > 1) out += "...";
  if (!is_argument() && most_each != 0) out += ' ' + placeholder;
  out += out.size() + 1 < meaning_column ? margin.substr(out.size()) : '\n' + margin;

  std::string more;  // " (1 to 8; default 2)"
  if (range && range->second <= most_to_mention) more = text(range->first, " to ", range->second);
  const std::string value = most_each == 0 ? std::string() : access.text(variable);
  const bool says_something = !value.empty() && value != "0" && value != "-1";
  if (says_something && meaning.find("default") == std::string::npos)
    more = text(more, more.empty() ? "default " : "; default ", value);
  for (const auto& word : split(more.empty() ? meaning : text(meaning, " (", more, ")"), ' ')) {
    const std::size_t column = out.size() - (out.rfind('\n') + 1);
    if (column > meaning_column)
      out += column + 1 + word.size() > most_columns ? '\n' + margin : " ";
    out += word;
  }
  return out + '\n';
}

std::string join(const Texts& texts, char separator) {
  std::string out;
  for (const std::string& one : texts) (out += one) += separator;
  if (!out.empty()) out.pop_back();
  return out;
}

Texts split(std::string_view text, char separator) {
  Texts parts;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    if (to > from) parts.emplace_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

void refuse(const std::string& message) {
  fail(ErrorCode::bad_argument, message, " (--help lists the options)");
}

}  // namespace tess::detail
