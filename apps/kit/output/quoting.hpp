// Any text as a field of CSV, as text of XML, as a string of gnuplot. Names of series, strategies
// and files come from users: they are quoted here and in runtime/core/escape.hpp, nowhere else.
#pragma once

#include "runtime/core/escape.hpp"

#include <string>
#include <string_view>

namespace kit {

/// A field of a line of CSV (RFC 4180): quoted where it must be; every byte is kept.
[[nodiscard]] std::string csv_field(std::string_view text);

/// The text in one line, as XML can hold it: control characters become spaces, bytes that are not
/// UTF-8, U+FFFE and U+FFFF become U+FFFD.
[[nodiscard]] std::string printable(std::string_view text);

/// Any text between tags or in an attribute.
using tess::xml_text;

/// Printable text as a gnuplot string without escapes, with its quotes.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

}  // namespace kit
