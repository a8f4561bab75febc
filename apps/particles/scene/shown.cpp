#include "apps/particles/scene/shown.hpp"

#include "runtime/core/text.hpp"

#include <nlohmann/json.hpp>

namespace particles {
namespace {
using nlohmann::json;

constexpr std::size_t longest_value = 60;

/// The longest beginning of so many bytes that ends between two characters of UTF-8.
std::string_view beginning(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::size_t end = longest;
  for (int i = 0; i < 3 && end > 0 && continues(end); ++i) --end;  // no character is longer
  return text.substr(0, end);
}

/// Appends the value until there is more than can be shown. Each level of nesting appends at least
/// a character before it goes deeper: the recursion ends where the text does.
void append(std::string& out, const json& value) {
  const char* between = "";
  if (value.is_array()) {
    out += '[';
    for (const json& item : value) {
      if (out.size() > longest_value) return;
      out += between;
      append(out, item);
      between = ",";
    }
    out += ']';
  } else if (value.is_object()) {
    out += '{';
    for (const auto& [key, item] : value.items()) {
      if (out.size() > longest_value) return;
      out += between;
      append(out, json(beginning(key, 2 * longest_value)));
      out += ':';
      append(out, item);
      between = ",";
    }
    out += '}';
  } else if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    out += json(beginning(text, 2 * longest_value))
               .dump(-1, ' ', false, json::error_handler_t::replace);
  } else {
    out += value.dump();
  }
}

}  // namespace

std::string shown_text(std::string_view text, std::size_t longest) {
  const std::string line = tess::one_line(beginning(text, longest));
  if (text.size() <= longest && line.size() <= longest) return line;
  return std::string(beginning(line, longest)) + " …";
}

std::string shown(const json& value) {
  std::string out;
  append(out, value);
  return shown_text(out, longest_value);
}

}  // namespace particles
