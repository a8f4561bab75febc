#include "runtime/core/text.hpp"

#include <array>
#include <charconv>
#include <sstream>

namespace tess {

std::string one_line(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\x";
      out += digits[byte >> 4U];
      out += digits[byte & 15U];
    } else {
      out += c;
    }
  }
  return out;
}

namespace detail {
namespace {

template <class... Format>
void append_characters(std::string& out, auto value, Format... format) {
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, format...).ptr;
  out.append(digits.data(), end);
}

}  // namespace

void append_number(std::string& out, std::int64_t value) {
  append_characters(out, value);
}
void append_number(std::string& out, std::uint64_t value) {
  append_characters(out, value);
}
void append_number(std::string& out, double value) {
  append_characters(out, value, std::chars_format::general, 6);
}

void append_streamed(std::string& out, const void* value,
                     void (*write)(std::ostream& out, const void* value)) {
  std::ostringstream stream;
  write(stream, value);
  out += std::move(stream).str();
}

}  // namespace detail
}  // namespace tess
