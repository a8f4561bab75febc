#include "runtime/core/escape.hpp"

#include <cstddef>
#include <cstdint>
#include <fmt/format.h>

namespace tess {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD

struct Character {
  std::size_t n_bytes = 0;  // 0: the text begins with no UTF-8 character
  std::uint32_t code = 0;
};

/// The UTF-8 character that `text` begins with (RFC 3629).
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  const std::size_t n = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < n) return {};
  std::uint32_t code = byte(0) & (0xffU >> (n + 1));
  for (std::size_t i = 1; i < n; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return {};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < least[n] || code > 0x10ffff || is_surrogate) return {};
  return {n, code};
}

/// Calls take(code, bytes) for each character; a byte that is not UTF-8 comes as U+FFFD.
template <class Take>
void for_each_character(std::string_view text, const Take& take) {
  while (!text.empty()) {
    const Character first = first_of(text);
    if (first.n_bytes == 0)
      take(0xfffd, replacement);
    else
      take(first.code, text.substr(0, first.n_bytes));
    text.remove_prefix(first.n_bytes == 0 ? 1 : first.n_bytes);
  }
}

/// Char of XML 1.0, of what UTF-8 can hold.
bool is_of_xml(std::uint32_t code) {
  if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
  return code != 0xfffe && code != 0xffff;
}

}  // namespace

std::string xml_characters(std::string_view text) {
  std::string out;
  for_each_character(text, [&](std::uint32_t code, std::string_view bytes) {
    out += is_of_xml(code) ? bytes : replacement;
  });
  return out;
}

std::string xml_text(std::string_view text) {
  std::string out;
  for_each_character(text, [&](std::uint32_t code, std::string_view bytes) {
    switch (code) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\t':
        out += "&#9;";
        break;
      case '\n':
        out += "&#10;";
        break;
      case '\r':
        out += "&#13;";
        break;
      default:
        out += is_of_xml(code) ? bytes : replacement;
    }
  });
  return out;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for_each_character(text, [&](std::uint32_t code, std::string_view bytes) {
    if (code < 0x20) {
      out += fmt::format("\\u{:04x}", code);
      return;
    }
    if (code == '"' || code == '\\') out += '\\';
    out += bytes;
  });
  return out + '"';
}

}  // namespace tess
