// Reading a JSON file key by key, so that whatever is wrong is named by its place:
//
//     scene.json: objects[1].resolution: 0 is not within 4 … 1024
//
// A Node is a value and its place. keys() of an object refuses keys that nobody knows; the readers
// of a value refuse a wrong type and a value out of range. All throw tess::Error(bad_value).
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace particles {

/// The numbers that a key may have.
struct Interval {
  double low = -HUGE_VAL, high = HUGE_VAL;
  enum class Low : std::uint8_t { included, excluded } at_low = Low::included;
};
inline constexpr Interval any_number{};
inline constexpr Interval positive{0, HUGE_VAL, Interval::Low::excluded};
inline constexpr Interval not_negative{0, HUGE_VAL};

/// No number of a file is larger: a length or a velocity can still be squared and multiplied by
/// another in doubles. What must be above 0 is at least its inverse, for the same reason.
inline constexpr double largest_number = 1e100, least_positive = 1e-100;

class Keys;

class Node {
 public:
  [[nodiscard]] double number(const Interval& allowed = any_number) const;
  [[nodiscard]] std::int64_t whole(std::int64_t low, std::int64_t high) const;
  [[nodiscard]] std::uint64_t seed() const;
  [[nodiscard]] bool is_yes_or_no() const;
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] bool yes_or_no() const;
  [[nodiscard]] std::string text() const;
  /// Which of these words it is.
  [[nodiscard]] std::size_t word(std::initializer_list<std::string_view> words) const;
  /// A list of three numbers.
  [[nodiscard]] tess::dn::Vec3 vector(const Interval& allowed = any_number) const;
  /// The items of a list; `least` of them at least.
  [[nodiscard]] std::vector<Node> items(std::size_t least = 0) const;
  /// The keys of an object, none but these.
  [[nodiscard]] Keys keys(std::initializer_list<std::string_view> known) const;

  /// Throws: the place, the value, and what is wrong with it.
  [[noreturn]] void refuse(const std::string& why) const;
  /// Throws: the place and what is wrong, where that says more than the value.
  [[noreturn]] void blame(const std::string& what) const;

 private:
  friend class Keys;
  friend class JsonFile;
  Node(const void* value, std::string file, std::string place)
      : value_(value), file_(std::move(file)), place_(std::move(place)) {}

  const void* value_;  // a nlohmann::json: its header stays in one source file
  std::string file_, place_;
};

/// The keys of one object. The readers with a variable leave it as it is where the key is absent.
class Keys {
 public:
  [[nodiscard]] bool has(std::string_view key) const;
  /// Throws where the key is absent; `what` says what to give.
  [[nodiscard]] Node need(std::string_view key, std::string_view what) const;
  [[nodiscard]] Node operator[](std::string_view key) const;

  void read(std::string_view key, double& into, const Interval& allowed = any_number) const;
  void read(std::string_view key, tess::dn::Vec3& into, const Interval& allowed = any_number) const;
  void read(std::string_view key, int& into, int low, int high) const;
  void read(std::string_view key, bool& into) const;

  /// The one key of those that is there; throws where there is none or more than one.
  [[nodiscard]] std::string_view one_of(std::initializer_list<std::string_view> keys) const;

 private:
  friend class Node;
  explicit Keys(Node node) : node_(std::move(node)) {}
  Node node_;
};

/// A parsed file. Throws Error(bad_file) where it cannot be read or is no JSON; a key that stands
/// twice in an object is refused.
class JsonFile {
 public:
  /// `path`: also the name of the file in messages.
  explicit JsonFile(const std::string& path);
  JsonFile(const std::string& text, const std::string& name);
  ~JsonFile();
  JsonFile(const JsonFile&) = delete;
  JsonFile& operator=(const JsonFile&) = delete;

  /// The whole file; valid as long as the JsonFile.
  [[nodiscard]] Node root() const;

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace particles
