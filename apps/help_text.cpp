#include "apps/help_text.hpp"

#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace apps {
namespace {

constexpr std::size_t meaning_column = 14;
constexpr std::size_t most_columns = 100;

/// Appends the words from the meaning's column on, in lines of at most `most_columns`.
std::string wrapped(std::string text, std::string_view words) {
  std::size_t column = text.size();
  if (column + 1 >= meaning_column) {
    text += '\n';
    column = 0;
  }
  text.append(meaning_column - column, ' ');
  column = meaning_column;
  std::istringstream in{std::string(words)};
  for (std::string word; in >> word;) {
    const bool is_first = column == meaning_column;
    if (!is_first && column + 1 + word.size() > most_columns) {
      text += '\n' + std::string(meaning_column, ' ');
      column = meaning_column;
    } else if (!is_first) {
      text += ' ';
      ++column;
    }
    text += word;
    column += word.size();
  }
  return text + '\n';
}

/// " (1 to 8; default 2)"; a meaning that speaks of its default is not told it again.
std::string range_and_default(const CLI::Option& option, const std::string& range) {
  std::string out = range;
  const std::string value = default_of(option);
  const bool says_something = !value.empty() && value != "0" && value != "-1" && value != "{}";
  if (says_something && option.get_description().find("default") == std::string::npos)
    out += (out.empty() ? "default " : "; default ") + value;
  return out.empty() ? out : " (" + out + ')';
}

}  // namespace

std::string default_of(const CLI::Option& option) {
  std::string text = option.get_default_str();
  std::erase_if(text, [](char c) { return c == '[' || c == ']'; });  // around several values
  return text;
}

std::string HelpText::make_help(const CLI::App* app, std::string name,
                                CLI::AppFormatMode /*mode*/) const {
  std::string out = make_description(app) + make_usage(app, std::move(name));
  const auto add = [&](const std::string& heading, bool positional, auto&& is_wanted) {
    const std::vector<const CLI::Option*> options = app->get_options([&](const CLI::Option* one) {
      return one->get_positional() == positional && is_wanted(*one);
    });
    if (!options.empty()) out += make_group(heading, positional, options);
  };
  add("Arguments", true, [](const CLI::Option&) { return true; });
  for (const std::string& group : app->get_groups())
    add(group, false, [&](const CLI::Option& one) { return one.get_group() == group; });
  return out + '\n' + make_footer(app);
}

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string type = option->get_type_name();  // "N: 1 to 8"
  const std::size_t colon = type.find(": ");
  const std::string takes = type.substr(0, colon);
  std::string name = "  " + option->get_name(is_positional, true);
  if (is_positional && option->get_items_expected_max() > 1) name += "...";
  if (!is_positional && !takes.empty()) name += ' ' + takes;
  const std::string range = colon == std::string::npos ? std::string() : type.substr(colon + 2);
  return wrapped(name, option->get_description() + range_and_default(*option, range));
}

}  // namespace apps
