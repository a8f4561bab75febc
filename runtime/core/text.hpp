// Concatenates values as text for messages to people. It needs no stream header, because the
// headers that all programs include must compile fast.
#pragma once

#include <concepts>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>

namespace tess {

namespace detail {

void append_number(std::string& out, std::int64_t value);
void append_number(std::string& out, std::uint64_t value);
void append_number(std::string& out, double value);  // six digits

/// Appends what `write` prints into a stream.
void append_streamed(std::string& out, const void* value,
                     void (*write)(std::ostream& out, const void* value));

template <class Part>
void append(std::string& out, const Part& part) {
  if constexpr (std::same_as<Part, char>) {
    out += part;
  } else if constexpr (std::unsigned_integral<Part>) {
    append_number(out, std::uint64_t{part});
  } else if constexpr (std::integral<Part>) {
    append_number(out, std::int64_t{part});
  } else if constexpr (std::floating_point<Part>) {
    append_number(out, static_cast<double>(part));
  } else if constexpr (std::convertible_to<const Part&, std::string_view>) {
    out += std::string_view(part);
  } else {
    append_streamed(out, &part, [](std::ostream& to, const void* value) {
      to << *static_cast<const Part*>(value);
    });
  }
}

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
  std::string out;
  (detail::append(out, parts), ...);
  return out;
}

/// The same for failures: it is kept out of the code that runs, and is not optimised.
template <Writable... Parts>
[[nodiscard, gnu::cold, gnu::noinline]] std::string failure_text(const Parts&... parts) {
  return text(parts...);
}

/// The text in one line: control characters become escapes (\n, \x1b). It is used for messages that
/// quote user input.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace tess
