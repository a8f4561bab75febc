// Text of users (names of fields, files, classes and series) inside XML and JSON that is written
// without a library: VTU and PVTU files, SVG pictures, the trace, the live view, the bench. The
// output is well-formed for any bytes. Each byte that is not UTF-8 (also of overlong characters, of
// surrogates, and above U+10FFFF) becomes U+FFFD: a strange name must not cost the results of a run.
// Where such a name must be refused, compare xml_characters() with it.
#pragma once

#include <string>
#include <string_view>

namespace tess {

/// The text as XML 1.0 can hold it, not yet escaped: what XML has no way to write becomes U+FFFD
/// (bytes that are not UTF-8, control characters other than tab, line feed and carriage return,
/// U+FFFE, U+FFFF). Equal to `text` if XML can hold all of it.
[[nodiscard]] std::string xml_characters(std::string_view text);

/// xml_characters() between tags, or in an attribute with double quotes: & < > " are escaped. So
/// are tabs and line ends, which a reader would otherwise change: any reader gets exactly
/// xml_characters() back.
[[nodiscard]] std::string xml_text(std::string_view text);

/// The text as a JSON string, with its quotation marks. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace tess
