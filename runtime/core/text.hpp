// Concatenates values as text for messages to people. It needs no stream header, because the
// headers that all programs include must compile fast.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>

namespace tess {

namespace detail {

/// A part of a text without its type, so that the code that appends parts is compiled only once. It
/// refers to the value.
class TextPart {
 public:
  template <class Value>
  explicit TextPart(const Value& value) {
    if constexpr (std::same_as<Value, char>) {
      kind_ = Kind::characters;
      characters_ = {&value, 1};
    } else if constexpr (std::unsigned_integral<Value>) {
      kind_ = Kind::unsigned_number;
      unsigned_ = value;
    } else if constexpr (std::integral<Value>) {
      kind_ = Kind::signed_number;
      signed_ = value;
    } else if constexpr (std::floating_point<Value>) {
      kind_ = Kind::real_number;
      real_ = static_cast<double>(value);
    } else if constexpr (std::convertible_to<const Value&, std::string_view>) {
      kind_ = Kind::characters;
      characters_ = std::string_view(value);
    } else {
      kind_ = Kind::streamed;
      streamed_ = {
          &value, [](std::ostream& out, const void* of) { out << *static_cast<const Value*>(of); }};
    }
  }
  void append_to(std::string& out) const;

 private:
  enum class Kind : std::uint8_t {
    characters,
    signed_number,
    unsigned_number,
    real_number,  ///< six digits
    streamed,
  };
  struct Streamed {
    const void* value;
    void (*write)(std::ostream& out, const void* value);
  };

  Kind kind_;
  union {
    std::string_view characters_;
    std::int64_t signed_;
    std::uint64_t unsigned_;
    double real_;
    Streamed streamed_;
  };
};

/// The parts as text, one after the other.
[[nodiscard]] std::string joined(std::initializer_list<TextPart> parts);

}  // namespace detail

/// Types that text() can write.
template <class Part>
concept Writable = std::integral<Part> || std::floating_point<Part> ||
                   std::convertible_to<const Part&, std::string_view> ||
                   requires(std::ostream& out, const Part& part) { out << part; };

/// The parts as text, one after the other: characters, numbers, strings, and any type with its own
/// operator<<.
template <Writable... Parts>
[[nodiscard]] std::string text(const Parts&... parts) {
  return detail::joined({detail::TextPart(parts)...});
}

/// The same for failures: it is kept out of the code that runs, and is not optimised.
template <Writable... Parts>
[[nodiscard, gnu::cold, gnu::noinline]] std::string failure_text(const Parts&... parts) {
  return detail::joined({detail::TextPart(parts)...});
}

/// The text in one line: control characters become escapes (\n, \x1b). It is used for messages that
/// quote user input.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace tess
