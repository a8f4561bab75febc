// Reads the tags of an XML text in order, as far as VTU files need it: elements, attributes, text,
// comments. It stops in front of data that is no XML, such as VTK's appended data. Views point into
// the text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tess::m2m {

struct XmlTag {
  enum class Kind { open, close, empty };
  Kind kind = Kind::open;
  std::string_view name{};
  std::string_view attributes{};
  std::string_view text_before{};  ///< since the last tag
  std::size_t end = 0;             ///< byte behind the tag

  /// None if there is no such attribute. Entities are replaced.
  [[nodiscard]] std::optional<std::string> attribute(std::string_view wanted) const;
};

class XmlScanner {
 public:
  explicit XmlScanner(std::string_view text) : text_(text) {}

  /// The next tag; none at the end of the text, or if a tag has no end.
  [[nodiscard]] std::optional<XmlTag> next();
  [[nodiscard]] std::size_t at() const noexcept { return at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace tess::m2m
