// JSON that programs write: a report builds a value and prints it once.
//
// A library for JSON, nlohmann's, is made of templates, which would be compiled into each source
// that builds a report. All that this class does is compiled once; it is used in the same way:
//
//     kit::Json out{{"machine", name}, {"cut", {{"seconds", 0.5}, {"triangles", 12}}}};
//     out["rows"] = kit::Json::array();
//     out["rows"].push_back({{"step", 1}, {"at", std::array{0.0, 0.5, 1.0}}});
//     kit::write_file(path, kit::json_text(out));
//
// Programs that read JSON use the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kit {

/// null, a boolean, a number, a string, an array or an object, whose members keep the order in
/// which they were added.
class Json {
 public:
  struct Member;
  /// A literal is true, false or an integer.
  enum class Kind : std::uint8_t { null, literal, real, string, array, object };

  Json(std::nullptr_t = nullptr);
  Json(bool value);
  Json(int value);
  Json(unsigned value);
  Json(long value);
  Json(unsigned long value);
  Json(double value);
  Json(const char* value);
  Json(std::string value);
  Json(std::string_view value);
  /// Any other pointer would be taken for a boolean.
  template <class T>
  Json(const T* value) = delete;
  template <class T>
  Json(const std::vector<T>& values) : Json(array()) {
    for (const T& value : values) push_back(value);
  }
  template <class T, std::size_t n>
  Json(const std::array<T, n>& values) : Json(array()) {
    for (const T& value : values) push_back(value);
  }
  template <class T>
  Json(const std::optional<T>& value) : Json(value ? Json(*value) : Json()) {}
  /// An object. No name may be repeated.
  Json(std::initializer_list<Member> members);
  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  /// An empty array.
  [[nodiscard]] static Json array();

  /// The member of an object. A member that is missing is added as null; null becomes an object.
  Json& operator[](std::string_view name);
  /// Appends to an array; null becomes an array.
  void push_back(Json value);
  /// Sets here all members of another object; null becomes an object.
  void update(const Json& object);

  [[nodiscard]] Kind kind() const { return kind_; }
  /// The text of a literal or a string, without quotation marks.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// The value of a real number.
  [[nodiscard]] double real() const { return real_; }
  /// The members of an object, or the elements of an array, which have empty names.
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  /// A member that an object has.
  [[nodiscard]] const Json& at(std::string_view name) const;

 private:
  Json(Kind kind, std::string text);

  Kind kind_ = Kind::null;
  double real_ = 0;
  std::string text_;
  std::vector<Member> members_;
};

struct Json::Member {
  Member(std::string_view its_name, Json its_value);
  Member(const Member& other);
  Member(Member&& other) noexcept;
  Member& operator=(const Member& other);
  Member& operator=(Member&& other) noexcept;
  ~Member();

  std::string name;
  Json value;
};

/// The text of a file, with a line end: each member and element stands in a line of its own,
/// `indent` blanks further in than the object or array; all is one line if `indent` is negative.
/// Numbers that are not finite become null. Bytes that are not UTF-8, as names of files may have,
/// become U+FFFD.
[[nodiscard]] std::string json_text(const Json& json, int indent = 2);

}  // namespace kit
