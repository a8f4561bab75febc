#include "apps/particles/scene/json_reader.hpp"

#include "apps/particles/scene/shown.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace particles {
namespace {
using nlohmann::json;
using tess::ErrorCode;
using tess::fail;

const json& at(const void* value) {
  return *static_cast<const json*>(value);
}

std::string listed(std::initializer_list<std::string_view> words) {
  std::string out;
  for (const std::string_view word : words) {
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out;
}

std::string below(const std::string& place, std::string_view key) {
  return place.empty() ? std::string(key) : fmt::format("{}.{}", place, key);
}

/// The library's text of a syntax error, without its own prefix.
std::string told(const json::exception& error) {
  const std::string whole = error.what();
  const auto at = whole.find("] ");
  constexpr std::size_t longest = 300;  // it quotes a text that is not closed as a whole
  return shown_text(std::string_view(whole).substr(at == std::string::npos ? 0 : at + 2), longest);
}

constexpr int deepest = 32;  // the library's recursions stay far from the end of the stack

json parse(const std::string& text, const std::string& name) {
  std::vector<std::set<std::string>> open;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    const bool opens =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= deepest)
      fail(ErrorCode::bad_file, name, ": is nested deeper than ", deepest,
           " lists and objects, and no key needs that; close them");
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
      fail(ErrorCode::bad_value, name, ": key ", shown(parsed), " stands twice in one object");
    return true;
  };
  try {
    return json::parse(text, watch);
  } catch (const json::exception& error) {
    fail(ErrorCode::bad_file, name, ": is not JSON: ", told(error));
  }
}

std::string contents(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    fail(ErrorCode::bad_file, path, ": is a directory; give the path of a JSON file");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  if (file) out << file.rdbuf();
  if (!file) fail(ErrorCode::bad_file, path, ": cannot be read; give the path of a JSON file");
  return out.str();
}

}  // namespace

void Node::refuse(const std::string& why) const {
  const std::string place = place_.empty() ? "the file" : place_;
  fail(ErrorCode::bad_value, file_, ": ", place, ": ", shown(at(value_)), " ", why);
}

void Node::blame(const std::string& what) const {
  fail(ErrorCode::bad_value, file_, ": ", place_, ": ", what);
}

double Node::number(const Interval& allowed) const {
  if (!at(value_).is_number()) refuse("is not a number");
  const auto value = at(value_).get<double>();
  if (std::abs(value) > largest_number)
    refuse(fmt::format("is beyond ±{:g}, the largest that can be reckoned with; choose other units",
                       largest_number));
  const bool above =
      allowed.at_low == Interval::Low::excluded ? value > allowed.low : value >= allowed.low;
  const bool tiny = allowed.at_low == Interval::Low::excluded && allowed.low == 0 && above &&
                    value < least_positive;
  if (tiny)
    refuse(fmt::format("is below {:g}, the least that can be reckoned with; choose other units",
                       least_positive));
  if (above && value <= allowed.high) return value;
  if (allowed.high < HUGE_VAL)
    refuse(fmt::format("is not within {} … {}", allowed.low, allowed.high));
  refuse(fmt::format("is not {} {}",
                     allowed.at_low == Interval::Low::excluded ? "above" : "at least",
                     allowed.low));
}

std::int64_t Node::whole(std::int64_t low, std::int64_t high) const {
  if (at(value_).is_number_float()) {  // 1e6 is whole, too
    constexpr double exact = 9007199254740992;
    const auto value = at(value_).get<double>();
    if (value != std::floor(value)) refuse("is not a whole number");
    if (std::abs(value) > exact || value < static_cast<double>(low) ||
        value > static_cast<double>(high))
      refuse(fmt::format("is not within {} … {}", low, high));
    return static_cast<std::int64_t>(value);
  }
  if (!at(value_).is_number_integer()) refuse("is not a whole number");
  const bool too_large = at(value_).is_number_unsigned() &&
                         at(value_).get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX);
  const auto value = at(value_).get<std::int64_t>();
  if (too_large || value < low || value > high)
    refuse(fmt::format("is not within {} … {}", low, high));
  return value;
}

std::uint64_t Node::seed() const {
  if (!at(value_).is_number_unsigned()) refuse("is not a whole number of at least 0");
  return at(value_).get<std::uint64_t>();
}

bool Node::is_yes_or_no() const {
  return at(value_).is_boolean();
}

bool Node::is_list() const {
  return at(value_).is_array();
}

bool Node::yes_or_no() const {
  if (!at(value_).is_boolean()) refuse("is neither true nor false");
  return at(value_).get<bool>();
}

std::string Node::text() const {
  if (!at(value_).is_string()) refuse("is not a text");
  return at(value_).get<std::string>();
}

std::size_t Node::word(std::initializer_list<std::string_view> words) const {
  if (at(value_).is_string()) {
    const auto given = at(value_).get<std::string>();
    const auto found = std::find(words.begin(), words.end(), given);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  refuse("is not one of " + listed(words));
}

tess::dn::Vec3 Node::vector(const Interval& allowed) const {
  if (!at(value_).is_array() || at(value_).size() != 3) refuse("is not a list of three numbers");
  const std::vector<Node> of = items();
  return {of[0].number(allowed), of[1].number(allowed), of[2].number(allowed)};
}

std::vector<Node> Node::items(std::size_t least) const {
  if (!at(value_).is_array()) refuse("is not a list");
  if (at(value_).size() < least) refuse(fmt::format("has fewer than {} items", least));
  std::vector<Node> out;
  for (const json& item : at(value_))
    out.push_back(Node(&item, file_, fmt::format("{}[{}]", place_, out.size())));
  return out;
}

Keys Node::keys(std::initializer_list<std::string_view> known) const {
  if (!at(value_).is_object()) refuse("is not an object with the keys " + listed(known));
  for (const auto& [key, value] : at(value_).items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(ErrorCode::bad_value, file_, ": ", below(place_, shown_text(key)),
           ": unknown key; allowed here: ", listed(known));
  return Keys(*this);
}

bool Keys::has(std::string_view key) const {
  return at(node_.value_).contains(key);
}

Node Keys::operator[](std::string_view key) const {
  return {&*at(node_.value_).find(key), node_.file_, below(node_.place_, key)};
}

Node Keys::need(std::string_view key, std::string_view what) const {
  if (!has(key))
    fail(ErrorCode::bad_value, node_.file_, ": ", below(node_.place_, key), ": is missing; give ",
         what);
  return (*this)[key];
}

void Keys::read(std::string_view key, double& into, const Interval& allowed) const {
  if (has(key)) into = (*this)[key].number(allowed);
}
void Keys::read(std::string_view key, tess::dn::Vec3& into, const Interval& allowed) const {
  if (has(key)) into = (*this)[key].vector(allowed);
}
void Keys::read(std::string_view key, int& into, int low, int high) const {
  if (has(key)) into = static_cast<int>((*this)[key].whole(low, high));
}
void Keys::read(std::string_view key, bool& into) const {
  if (has(key)) into = (*this)[key].yes_or_no();
}

std::string_view Keys::one_of(std::initializer_list<std::string_view> keys) const {
  std::string_view found;
  int n_found = 0;
  for (const std::string_view key : keys) {
    if (!has(key)) continue;
    found = key;
    ++n_found;
  }
  if (n_found != 1)
    node_.refuse(fmt::format("needs exactly one of {}, not {}", listed(keys), n_found));
  return found;
}

struct JsonFile::Parsed {
  std::string name;
  json value;
};

JsonFile::JsonFile(const std::string& path) : JsonFile(contents(path), path) {}
JsonFile::JsonFile(const std::string& text, const std::string& name)
    : parsed_(std::make_unique<Parsed>(Parsed{name, parse(text, name)})) {}
JsonFile::~JsonFile() = default;

Node JsonFile::root() const {
  return {&parsed_->value, parsed_->name, {}};
}

}  // namespace particles
