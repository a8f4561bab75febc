#include "m2m/io/vtu/xml_scanner.hpp"

#include "runtime/core/number.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Writes a character in UTF-8.
void append(std::uint32_t character, std::string& out) {
  if (character < 0x80) {
    out.push_back(static_cast<char>(character));
    return;
  }
  const int n_more = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  out.push_back(static_cast<char>((0xFF00U >> (n_more + 1)) | (character >> (6 * n_more))));
  for (int i = n_more; i-- > 0;)
    out.push_back(static_cast<char>(0x80U | ((character >> (6 * i)) & 0x3FU)));
}

/// Reads a number such as "&#39;" or "&#x27;" to the character that it names. Its length, or 0 if
/// the text does not begin with one.
std::size_t read_number(std::string_view text, std::string& out) {
  if (!text.starts_with("&#")) return 0;
  const bool is_hex = text.substr(2).starts_with("x");
  std::string_view rest = text.substr(is_hex ? 3 : 2);
  const auto character = take_number<std::uint32_t>(rest, is_hex ? 16 : 10);
  if (!character || !rest.starts_with(';') || *character == 0 || *character > 0x10FFFF) return 0;
  append(*character, out);
  return text.size() - rest.size() + 1;
}

std::string without_entities(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> entities{
      {{"&quot;", '"'}, {"&apos;", '\''}, {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}}};
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t n = read_number(text.substr(at), out); n > 0) {
      at += n;
      continue;
    }
    std::size_t length = 1;
    char c = text[at];
    for (const auto& [entity, meaning] : entities)
      if (text.substr(at).starts_with(entity)) {
        length = entity.size();
        c = meaning;
      }
    out.push_back(c);
    at += length;
  }
  return out;
}

}  // namespace

std::optional<std::string> XmlTag::attribute(std::string_view wanted) const {
  std::string_view rest = attributes;
  while (true) {
    const std::size_t begin = rest.find_first_not_of(blanks);
    const std::size_t equals = rest.find('=');
    if (begin == std::string_view::npos || equals == std::string_view::npos || equals < begin)
      return std::nullopt;
    std::string_view found = rest.substr(begin, equals - begin);
    found = found.substr(0, found.find_last_not_of(blanks) + 1);
    const std::size_t open = rest.find_first_not_of(blanks, equals + 1);
    if (open == std::string_view::npos || (rest[open] != '"' && rest[open] != '\''))
      return std::nullopt;
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    if (found == wanted) return without_entities(rest.substr(open + 1, close - open - 1));
    rest = rest.substr(close + 1);
  }
}

std::optional<XmlTag> XmlScanner::next() {
  const std::size_t text_begin = at_;
  while (true) {
    const std::size_t begin = text_.find('<', at_);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::string_view rest = text_.substr(begin);
    // Comments and declarations.
    if (rest.starts_with("<!--") || rest.starts_with("<?") || rest.starts_with("<!")) {
      const std::string_view end = rest.starts_with("<!--")        ? "-->"
                                   : rest.starts_with("<![CDATA[") ? "]]>"
                                                                   : ">";
      const std::size_t close = rest.find(end);
      if (close == std::string_view::npos) return std::nullopt;
      at_ = begin + close + end.size();
      continue;
    }
    char quote = 0;
    std::size_t close = 1;
    while (close < rest.size() && (quote != 0 || rest[close] != '>')) {
      if (quote != 0) {
        if (rest[close] == quote) quote = 0;
      } else if (rest[close] == '"' || rest[close] == '\'') {
        quote = rest[close];
      }
      ++close;
    }
    if (close >= rest.size()) return std::nullopt;
    XmlTag tag;
    tag.text_before = text_.substr(text_begin, begin - text_begin);
    std::string_view inside = rest.substr(1, close - 1);
    if (inside.starts_with("/")) {
      tag.kind = XmlTag::Kind::close;
      inside.remove_prefix(1);
    } else if (inside.ends_with("/")) {
      tag.kind = XmlTag::Kind::empty;
      inside.remove_suffix(1);
    }
    tag.name = inside.substr(0, inside.find_first_of(blanks));
    tag.attributes = inside.substr(tag.name.size());
    at_ = tag.end = begin + close + 1;
    return tag;
  }
}

}  // namespace tess::m2m
