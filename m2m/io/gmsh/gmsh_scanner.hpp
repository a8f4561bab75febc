// Reads the bytes of one MSH file in order: section names, and numbers as text or binary, as the
// mode of the file requires. Every read is checked against the end of the file. A failure is one
// line of error with the byte position.
#pragma once

#include "m2m/io/text_number.hpp"
#include "runtime/core/error.hpp"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace tess::m2m {

class GmshScanner {
 public:
  GmshScanner(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  void set_binary(bool binary) { binary_ = binary; }
  [[nodiscard]] bool binary() const { return binary_; }
  [[nodiscard]] bool at_end() const { return at_ >= bytes_.size(); }
  /// The position, in bytes.
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  template <class... Parts>
  [[noreturn]] void damaged(const Parts&... parts) const {
    fail(ErrorCode::bad_file, path_, ": is truncated or damaged (byte ", at_, ": ", parts...,
         "); write the mesh again");
  }
  template <class... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    fail(ErrorCode::bad_mesh, path_, ": ", parts...);
  }

  void skip_blanks() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
  }

  /// The next word of text.
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }

  /// The text between two quotation marks on one line, or the next word.
  std::string_view quoted() {
    skip_blanks();
    if (at_ >= bytes_.size() || bytes_[at_] != '"') return word();
    const std::size_t begin = at_ + 1;
    const std::size_t end = bytes_.find_first_of("\"\n", begin);
    if (end == std::string_view::npos || bytes_[end] != '"') damaged("a name has no end");
    at_ = end + 1;
    return bytes_.substr(begin, end - begin);
  }

  void move_to(std::size_t at) { at_ = at; }

  /// A number as text, in either mode.
  template <class T>
  T number_as_text() {
    const std::string_view text = word();
    T value{};
    const char* const end = text.data() + text.size();
    if (text.empty() || read_text_number(text.data(), end, value) != end)
      damaged("expected a number, found '", printable(text), "'");
    return value;
  }

  /// The next number in the current mode; in binary it has exactly the width of T.
  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    if (!binary_) return number_as_text<T>();
    if (left() < sizeof(T)) damaged("expected ", sizeof(T), " bytes, only ", left(), " are left");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  /// A count of items of at least `bytes_each` bytes each (as text: two, a digit and a blank).
  template <class T>
  std::size_t count(std::string_view what, std::size_t bytes_each) {
    const T n = number<T>();
    return checked_count(n, what, bytes_each);
  }
  template <class T>
  std::size_t checked_count(T n, std::string_view what, std::size_t bytes_each) const {
    const std::size_t each = binary_ ? bytes_each : 2;
    if (std::is_signed_v<T> && n < T{0}) damaged(n, " ", what);
    if (static_cast<std::uint64_t>(n) > (left() + 1) / each)
      damaged(n, " ", what, " do not fit in the file");
    return static_cast<std::size_t>(n);
  }

  /// Skips `n` numbers of type T.
  template <class T>
  void skip(std::size_t n) {
    if (!binary_) {
      for (std::size_t i = 0; i < n; ++i) {
        if (word().empty()) damaged("expected a number");
      }
    } else {
      if (left() / sizeof(T) < n) damaged("expected ", n, " numbers");
      at_ += n * sizeof(T);
    }
  }

  /// Reads the one line break after a header, where binary data begins.
  void end_of_line() {
    if (at_ < bytes_.size() && bytes_[at_] == '\r') ++at_;
    if (at_ >= bytes_.size() || bytes_[at_] != '\n') damaged("expected the end of a line");
    ++at_;
  }

  /// Reads the tag that closes a section.
  void close(std::string_view tag) {
    const std::string_view found = word();
    if (found != tag) damaged("expected ", tag, ", found '", printable(found), "'");
  }

  /// Skips everything up to and including the tag.
  void skip_to(const std::string& tag) {
    const std::size_t found = bytes_.find(tag, at_);
    if (found == std::string_view::npos) damaged(tag, " is missing");
    at_ = found + tag.size();
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
  static std::string printable(std::string_view text) {
    std::string shown(text.substr(0, 24));
    for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
    return shown;
  }

  const std::string& path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool binary_ = false;
};

}  // namespace tess::m2m
