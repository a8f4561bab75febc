// Text of any bytes in XML and JSON: a reader of the format, and for UTF-8 the JSON library, say
// whether it is well-formed.
#include "runtime/core/escape.hpp"

#include "tests/apps/xml.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

const std::string replacement = "\xef\xbf\xbd";  // U+FFFD

bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

/// True if XML can hold every character of a text that is UTF-8.
bool fits_xml(const std::string& text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') return false;
  return text.find("\xef\xbf\xbe") == std::string::npos &&
         text.find("\xef\xbf\xbf") == std::string::npos;
}

/// What is wrong with `text` in JSON; empty if nothing is.
std::string fault_in_json(const std::string& text) {
  const auto parsed =
      nlohmann::json::parse(tess::json_string(text), nullptr, false).get<std::string>();
  if (is_utf8(text)) return parsed == text ? "" : "a text is not read back";
  return parsed.find(replacement) != std::string::npos ? "" : "bytes are lost";
}

/// The same in an attribute and between tags of XML.
std::string fault_in_xml(const std::string& text) {
  const std::string characters = tess::xml_characters(text);
  if (!is_utf8(characters) || !fits_xml(characters)) return "XML cannot hold the characters";
  if ((characters == text) != (is_utf8(text) && fits_xml(text))) return "a wrong text is replaced";
  const std::string written = tess::xml_text(text);
  if (written.find_first_of("\t\n\r") != std::string::npos) return "a reader changes blanks";
  const auto elements = tess::test::read_xml("<t name=\"" + written + "\">" + written + "</t>");
  if (elements[0].text != characters) return "the text is not read back";
  return elements[0].attributes == " name=\"" + characters + "\""
             ? ""
             : "the attribute is not read back";
}

/// Texts of all bytes, all pairs of them, and sequences of those that are special to UTF-8, XML or
/// JSON.
std::vector<std::string> all_texts() {
  std::vector<std::string> texts{
      "", "Größe → ∞ \xf0\x9f\x9a\x80", "Cell<\"a\\b\">\n", "]]>", "&amp;", "<!-- -->", "it's"};
  for (int a = 0; a < 256; ++a) {
    texts.emplace_back(1, static_cast<char>(a));
    for (int b = 0; b < 256; ++b) texts.push_back({static_cast<char>(a), static_cast<char>(b)});
  }
  const std::string leads = "\xc2\xdf\xe0\xe1\xec\xed\xee\xef\xf0\xf1\xf3\xf4\xf5\xff";
  const std::string others = "\x80\x8f\x90\x9f\xa0\xbe\xbf\xc0\xc3\n<a";
  for (const char lead : leads)
    for (const char b : others)
      for (const char c : others)
        for (const char d : others) {
          texts.push_back({lead, b, c});
          texts.push_back({lead, b, c, d});
        }
  return texts;
}

}  // namespace

TEST_CASE("a JSON library reads every character of a JSON string back", "[runtime]") {
  std::string all;
  for (int c = 0; c < 128; ++c) all += static_cast<char>(c);
  all += "Größe → ∞";
  CHECK(nlohmann::json::parse(tess::json_string(all)) == all);
  CHECK(tess::json_string("\x01\x7f\"\\") == "\"\\u0001\x7f\\\"\\\\\"");
}

TEST_CASE("any bytes give XML and JSON that are well-formed, and hold what can be held",
          "[runtime]") {
  for (const std::string& text : all_texts()) {
    const std::string fault = fault_in_json(text) + fault_in_xml(text);
    if (fault.empty()) continue;
    CAPTURE(tess::json_string(text));
    FAIL(fault);
  }
}

TEST_CASE("each byte that XML or JSON cannot hold becomes one U+FFFD", "[runtime]") {
  const std::string& bad = replacement;
  for (const auto& [text, n] : {std::pair<std::string, int>{"\xc3", 1},
                                {"\xc0\x80", 2},          // overlong
                                {"\xed\xa0\x80", 3},      // a surrogate
                                {"\xf4\x90\x80\x80", 4},  // above U+10FFFF
                                {"\xe2\x86", 2}}) {       // cut
    std::string want;
    for (int i = 0; i < n; ++i) want += bad;
    CHECK(tess::xml_characters(text) == want);
    CHECK(tess::xml_text(text) == want);
    CHECK(tess::json_string(text) == '"' + want + '"');
  }
  CHECK(tess::xml_characters(std::string("a\0b\x1f", 4)) == "a" + bad + "b" + bad);
  CHECK(tess::xml_characters("\xef\xbf\xbf") == bad);  // U+FFFF, which JSON can hold
  CHECK(tess::json_string("\xef\xbf\xbf") == "\"\xef\xbf\xbf\"");
  CHECK(tess::xml_text("<a b=\"c\">&\n") == "&lt;a b=&quot;c&quot;&gt;&amp;&#10;");
}
