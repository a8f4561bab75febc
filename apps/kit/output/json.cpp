#include "apps/kit/output/json.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/detail/conversions/to_chars.hpp>
#include <utility>

namespace kit {
namespace {

/// How many bytes the UTF-8 character has that `text` begins with (RFC 3629), or that could have
/// begun one before a wrong byte or the end.
struct Character {
  std::size_t n_bytes;
  bool is_whole;
};

Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, true};
  if (lead < 0xc2 || lead > 0xf4) return {1, false};
  const std::size_t n = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  // No character is longer than it has to be, a surrogate, or above U+10FFFF.
  unsigned char least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
  unsigned char most = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
  for (std::size_t i = 1; i < n; ++i) {
    if (i == text.size() || byte(i) < least || byte(i) > most) return {i, false};
    least = 0x80;
    most = 0xbf;
  }
  return {n, true};
}

std::string escaped(char c) {
  constexpr std::string_view special = "\"\\\b\f\n\r\t", letters = "\"\\bfnrt";
  if (const std::size_t at = special.find(c); at != std::string_view::npos)
    return {'\\', letters[at]};
  return static_cast<unsigned char>(c) < 0x20 ? fmt::format("\\u{:04x}", c) : std::string(1, c);
}

/// Writes values one after the other.
struct Writer {
  std::string out{};
  int indent;

  void quote(std::string_view text) {
    out += '"';
    while (!text.empty()) {
      const Character first = first_of(text);
      if (!first.is_whole)
        out += "\xef\xbf\xbd";
      else if (first.n_bytes == 1)
        out += escaped(text[0]);
      else
        out += text.substr(0, first.n_bytes);
      text.remove_prefix(first.n_bytes);
    }
    out += '"';
  }

  void real(double value) {
    if (!std::isfinite(value)) {
      out += "null";
      return;
    }
    // One number of a thousand has a digit more than std::to_chars() would give it. The library's
    // digits keep results comparable with those that are kept.
    char digits[64];
    out.append(digits, nlohmann::detail::to_chars(digits, std::end(digits), value));
  }

  void new_line(int depth) {
    if (indent < 0) return;
    out += '\n';
    out.append(static_cast<std::size_t>(depth) * static_cast<std::size_t>(indent), ' ');
  }

  void members(const Json& json, int depth, std::string_view brackets) {
    out += brackets[0];
    const char* separator = "";
    for (const auto& [name, value] : json.members()) {
      out += std::exchange(separator, ",");
      new_line(depth + 1);
      if (json.kind() == Json::Kind::object) {
        quote(name);
        out += indent < 0 ? ":" : ": ";
      }
      write(value, depth + 1);
    }
    if (!json.members().empty()) new_line(depth);
    out += brackets[1];
  }

  void write(const Json& json, int depth) {
    switch (json.kind()) {
      case Json::Kind::null:
        out += "null";
        return;
      case Json::Kind::literal:
        out += json.text();
        return;
      case Json::Kind::real:
        real(json.real());
        return;
      case Json::Kind::string:
        quote(json.text());
        return;
      case Json::Kind::array:
        members(json, depth, "[]");
        return;
      case Json::Kind::object:
        members(json, depth, "{}");
    }
  }
};

}  // namespace

Json::Json(Kind kind, std::string text) : kind_(kind), text_(std::move(text)) {}
Json::Json(std::nullptr_t) {}
Json::Json(bool value) : Json(Kind::literal, value ? "true" : "false") {}
Json::Json(int value) : Json(Kind::literal, std::to_string(value)) {}
Json::Json(unsigned value) : Json(Kind::literal, std::to_string(value)) {}
Json::Json(long value) : Json(Kind::literal, std::to_string(value)) {}
Json::Json(unsigned long value) : Json(Kind::literal, std::to_string(value)) {}
Json::Json(double value) : kind_(Kind::real), real_(value) {}
Json::Json(const char* value) : Json(Kind::string, value) {}
Json::Json(std::string value) : Json(Kind::string, std::move(value)) {}
Json::Json(std::string_view value) : Json(Kind::string, std::string(value)) {}
Json::Json(std::initializer_list<Member> members) : kind_(Kind::object), members_(members) {}
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json::Member::Member(std::string_view its_name, Json its_value)
    : name(its_name), value(std::move(its_value)) {}
Json::Member::Member(const Member& other) = default;
Json::Member::Member(Member&& other) noexcept = default;
Json::Member& Json::Member::operator=(const Member& other) = default;
Json::Member& Json::Member::operator=(Member&& other) noexcept = default;
Json::Member::~Member() = default;

Json Json::array() {
  return {Kind::array, ""};
}

Json& Json::operator[](std::string_view name) {
  if (kind_ == Kind::null) kind_ = Kind::object;
  TESS_CHECK(kind_ == Kind::object, "a member '", name, "' of a JSON value that is no object");
  const auto found = std::ranges::find(members_, name, &Member::name);
  return found != members_.end() ? found->value : members_.emplace_back(name, nullptr).value;
}

void Json::push_back(Json value) {
  if (kind_ == Kind::null) kind_ = Kind::array;
  TESS_CHECK(kind_ == Kind::array, "push_back() to a JSON value that is no array");
  members_.emplace_back("", std::move(value));
}

void Json::update(const Json& object) {
  if (kind_ == Kind::null) kind_ = Kind::object;
  for (const auto& [name, value] : object.members_) (*this)[name] = value;
}

const Json& Json::at(std::string_view name) const {
  const auto found = std::ranges::find(members_, name, &Member::name);
  TESS_CHECK(found != members_.end(), "a JSON value has no member '", name, "'");
  return found->value;
}

std::string json_text(const Json& json, int indent) {
  Writer writer{.indent = indent};
  writer.write(json, 0);
  return writer.out + '\n';
}

}  // namespace kit
