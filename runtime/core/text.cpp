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

void TextPart::append_to(std::string& out) const {
  switch (kind_) {
    case Kind::characters:
      out += characters_;
      break;
    case Kind::signed_number:
      append_characters(out, signed_);
      break;
    case Kind::unsigned_number:
      append_characters(out, unsigned_);
      break;
    case Kind::real_number:
      append_characters(out, real_, std::chars_format::general, 6);
      break;
    case Kind::streamed: {
      std::ostringstream stream;
      streamed_.write(stream, streamed_.value);
      out += std::move(stream).str();
    }
  }
}

std::string joined(std::initializer_list<TextPart> parts) {
  std::string out;
  for (const TextPart& part : parts) part.append_to(out);
  return out;
}

}  // namespace detail
}  // namespace tess
