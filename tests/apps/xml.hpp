// A strict reader of small XML documents, for tests of our own output. Every tag must be closed in
// order, attributes must be quoted, and characters must be escaped where XML requires it.
#pragma once

#include <cctype>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tess::test {

struct XmlElement {
  std::string name;
  std::string attributes;  ///< as written
  std::string text;        ///< directly in it, entities resolved
};

/// Returns all elements of a document in the order of their start tags. Throws std::runtime_error
/// if the document is not well-formed.
inline std::vector<XmlElement> read_xml(std::string_view in) {
  std::vector<XmlElement> elements;
  std::vector<std::size_t> open;
  bool root_closed = false;
  const auto refuse = [&](const std::string& why) -> void {
    throw std::runtime_error(why + " before: " + std::string(in.substr(0, 60)));
  };
  const auto skip_past = [&](std::string_view end) {
    const std::size_t at = in.find(end);
    if (at == std::string_view::npos) refuse("no " + std::string(end));
    in.remove_prefix(at + end.size());
  };
  const auto entity = [&] {
    for (const auto& [name, value] : {std::pair<std::string_view, char>{"&amp;", '&'},
                                      {"&lt;", '<'},
                                      {"&gt;", '>'},
                                      {"&quot;", '"'},
                                      {"&apos;", '\''},
                                      {"&#9;", '\t'},
                                      {"&#10;", '\n'},
                                      {"&#13;", '\r'}}) {
      if (!in.starts_with(name)) continue;
      in.remove_prefix(name.size());
      return value;
    }
    refuse("bad entity");
    return '\0';
  };
  while (!in.empty()) {
    if (in.starts_with("<?")) {
      skip_past("?>");
    } else if (in.starts_with("<!--")) {
      skip_past("-->");
    } else if (in.starts_with("<!")) {
      skip_past(">");
    } else if (in.starts_with("</")) {
      in.remove_prefix(2);
      if (open.empty() || !in.starts_with(elements[open.back()].name)) refuse("wrong end tag");
      in.remove_prefix(elements[open.back()].name.size());
      skip_past(">");
      open.pop_back();
      root_closed = open.empty();
    } else if (in.starts_with("<")) {
      if (root_closed) refuse("a second root");
      in.remove_prefix(1);
      XmlElement element;
      while (!in.empty() && std::isalnum(static_cast<unsigned char>(in[0])) != 0) {
        element.name += in[0];
        in.remove_prefix(1);
      }
      if (element.name.empty()) refuse("no tag name");
      char quote = '\0';
      while (!in.empty() && (quote != '\0' || in[0] != '>')) {
        if (in[0] == '<') refuse("< in a tag");
        if (quote != '\0' && in[0] == '&') {
          element.attributes += entity();
          continue;
        }
        if (quote == '\0' && (in[0] == '"' || in[0] == '\''))
          quote = in[0];
        else if (in[0] == quote)
          quote = '\0';
        element.attributes += in[0];
        in.remove_prefix(1);
      }
      if (in.empty()) refuse("a tag without end");
      in.remove_prefix(1);
      elements.push_back(element);
      if (element.attributes.ends_with('/'))
        root_closed = open.empty();
      else
        open.push_back(elements.size() - 1);
    } else {
      const auto byte = static_cast<unsigned char>(in[0]);
      if (byte < 0x20 && byte != '\n' && byte != '\t' && byte != '\r') refuse("control character");
      if (in.starts_with("]]>")) refuse("]]>");
      if (open.empty() && std::isspace(byte) == 0) refuse("text outside of the root");
      const bool escaped = in[0] == '&';
      const char c = escaped ? entity() : in[0];
      if (!escaped) in.remove_prefix(1);
      if (!open.empty()) elements[open.back()].text += c;
    }
  }
  if (!root_closed) refuse("not all closed");
  return elements;
}

}  // namespace tess::test
