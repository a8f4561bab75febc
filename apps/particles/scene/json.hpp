// Reading a JSON file so that every mistake is named by its place:
//
//     scene.json: objects[1].resolution: 0 is not within 4 … 1024
//
// A Node is a value and its place. Node::read() fills variables from the keys of an object by a
// table, refuses keys that are not in it, and names those that are missing:
//
//     node.read({{"rate", drag.rate, not_negative, "force per velocity"},  // must be there
//                {"threshold", drag.threshold, positive}});                // stays if it is not
//
// All throw tess::Error: bad_value, or bad_file where the file cannot be read or is not JSON.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace particles {

/// The numbers that a key may have.
struct Interval {
  double low = -HUGE_VAL, high = HUGE_VAL;
  bool is_open = false;  ///< low itself is not allowed
};
inline constexpr Interval any_number{}, positive{0, HUGE_VAL, true}, not_negative{0, HUGE_VAL};

/// No number of a file is larger: a length or a velocity can still be squared and multiplied by
/// another in doubles. A number that must be above 0 is at least the inverse, for the same reason.
inline constexpr double largest_number = 1e100, least_positive = 1e-100;

inline constexpr std::int64_t largest_whole = std::int64_t{1} << 53;

using Words = std::vector<std::string_view>;
[[nodiscard]] inline Words words_of(const auto& names) {
  return {std::begin(names), std::end(names)};
}
class Key;

class Node {
 public:
  /// `value` outlives the node. `file`: its name in messages.
  Node(const nlohmann::json& value, std::string file, std::string place = {})
      : value_(&value), file_(std::move(file)), place_(std::move(place)) {}

  /// Reads the keys of an object, in the order of the table.
  void read(std::initializer_list<Key> table) const;
  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] Node operator[](std::string_view key) const;
  /// The one key of those that is there; throws where there is none or more than one.
  [[nodiscard]] std::string_view one_of(const Words& keys) const;

  [[nodiscard]] double number(const Interval& allowed = any_number) const;
  /// Bounds within ±largest_whole, so that doubles hold all values.
  [[nodiscard]] std::int64_t whole(std::int64_t low, std::int64_t high) const;
  [[nodiscard]] bool is_yes_or_no() const;
  [[nodiscard]] bool yes_or_no() const;
  [[nodiscard]] std::string text() const;
  /// The position in `words`.
  [[nodiscard]] std::size_t word(const Words& words) const;
  /// A list of three numbers.
  [[nodiscard]] tess::dn::Vec3 vector(const Interval& allowed = any_number) const;
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] std::vector<Node> items(std::size_t least = 0) const;

  /// Throws: the place, the value, and what is wrong with it.
  [[noreturn]] void refuse(const std::string& why) const;
  /// Throws: the place and what is wrong, where that says more than the value.
  [[noreturn]] void blame(const std::string& what) const;

 private:
  [[nodiscard]] std::string below(std::string_view key) const;

  const nlohmann::json* value_;
  std::string file_, place_;
};

/// A key of a table: how its value is read. `needed` says what to give where the key is missing;
/// null: the key may be left out, and the variable stays as it is.
class Key {
 public:
  template <std::invocable<const Node&> Take>
  Key(std::string_view name, Take take, const char* needed = nullptr)
      : name_(name), needed_(needed), take_(std::move(take)) {}
  Key(std::string_view name, double& into, const Interval& allowed = any_number,
      const char* needed = nullptr)
      : Key(
            name, [=, &into](const Node& node) { into = node.number(allowed); }, needed) {}
  Key(std::string_view name, tess::dn::Vec3& into, const Interval& allowed = any_number,
      const char* needed = nullptr)
      : Key(
            name, [=, &into](const Node& node) { into = node.vector(allowed); }, needed) {}
  Key(std::string_view name, bool& into)
      : Key(name, [&into](const Node& node) { into = node.yes_or_no(); }) {}
  template <std::integral T>
  Key(std::string_view name, T& into, std::int64_t low, std::int64_t high,
      const char* needed = nullptr)
      : Key(
            name, [=, &into](const Node& node) { into = static_cast<T>(node.whole(low, high)); },
            needed) {}
  /// The words stand in the order of the enumerators.
  template <class Enum>
    requires std::is_enum_v<Enum>
  Key(std::string_view name, Enum& into, Words words)
      : Key(name, [words = std::move(words), &into](const Node& node) {
          into = static_cast<Enum>(node.word(words));
        }) {}

 private:
  friend class Node;
  std::string_view name_;
  const char* needed_;
  std::function<void(const Node&)> take_;
};

/// The contents of a file. A key that stands twice in an object is refused.
[[nodiscard]] nlohmann::json read_json(const std::string& path);
/// `name`: of the file, in messages.
[[nodiscard]] nlohmann::json parse_json(const std::string& text, const std::string& name);

/// A text as messages show it: in one line, cut between characters of UTF-8; " …" stands for what
/// is beyond `longest` bytes.
[[nodiscard]] std::string shown(std::string_view text, std::size_t longest = 60);

}  // namespace particles
