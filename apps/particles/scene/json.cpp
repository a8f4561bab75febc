#include "apps/particles/scene/json.hpp"

#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace particles {
namespace {
using nlohmann::json;
using tess::ErrorCode;
using tess::fail;

/// The longest beginning of so many bytes that ends between two characters of UTF-8, of which all
/// bytes but the first are 10xxxxxx.
std::string_view beginning(std::string_view text, std::size_t longest) {
  std::size_t end = std::min(longest, text.size());
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;
  return text.substr(0, end);
}

}  // namespace

std::string shown(std::string_view text, std::size_t longest) {
  const std::string line = tess::one_line(beginning(text, longest));
  if (text.size() <= longest && line.size() <= longest) return line;
  return std::string(beginning(line, longest)) + " …";
}

json parse_json(const std::string& text, const std::string& name) {
  constexpr int deepest = 32;  // the library's recursions stay far from the end of the stack
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
      fail(ErrorCode::bad_value, name, ": key ", shown(parsed.dump()),
           " stands twice in one object");
    return true;
  };
  try {
    return json::parse(text, watch);
  } catch (const json::exception& error) {
    const std::string_view what = error.what();  // "[json.exception.parse_error.101] parse error …"
    const auto end = what.find("] ");
    fail(ErrorCode::bad_file, name,
         ": is not JSON: ", shown(what.substr(end == std::string::npos ? 0 : end + 2), 300));
  }
}

json read_json(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    fail(ErrorCode::bad_file, path, ": is a directory; give the path of a JSON file");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  if (file) out << file.rdbuf();
  if (!file) fail(ErrorCode::bad_file, path, ": cannot be read; give the path of a JSON file");
  return parse_json(out.str(), path);
}

std::string Node::below(std::string_view key) const {
  return place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key);
}

void Node::refuse(const std::string& why) const {
  const std::string value = value_->dump(-1, ' ', false, json::error_handler_t::replace);
  fail(ErrorCode::bad_value, file_, ": ", place_.empty() ? "the file" : place_, ": ", shown(value),
       " ", why);
}

void Node::blame(const std::string& what) const {
  fail(ErrorCode::bad_value, file_, ": ", place_, ": ", what);
}

void Node::read(std::initializer_list<Key> table) const {
  Words names;
  for (const Key& key : table) names.push_back(key.name_);
  const std::string allowed = fmt::format("{}", fmt::join(names, ", "));
  if (!value_->is_object()) refuse("is not an object with the keys " + allowed);
  for (const auto& [key, value] : value_->items())
    if (std::ranges::find(names, key) == names.end())
      fail(ErrorCode::bad_value, file_, ": ", below(shown(key)),
           ": unknown key; allowed here: ", allowed, tess::did_you_mean(key, allowed));
  for (const Key& key : table) {
    if (has(key.name_))
      key.take_((*this)[key.name_]);
    else if (key.needed_ != nullptr)
      fail(ErrorCode::bad_value, file_, ": ", below(key.name_), ": is missing; give ", key.needed_);
  }
}

bool Node::has(std::string_view key) const {
  return value_->contains(key);
}

Node Node::operator[](std::string_view key) const {
  return {*value_->find(key), file_, below(key)};
}

std::string_view Node::one_of(const Words& keys) const {
  const auto n = std::ranges::count_if(keys, [&](std::string_view key) { return has(key); });
  if (n != 1) refuse(fmt::format("needs exactly one of {}, not {}", fmt::join(keys, ", "), n));
  return *std::ranges::find_if(keys, [&](std::string_view key) { return has(key); });
}

double Node::number(const Interval& allowed) const {
  if (!value_->is_number()) refuse("is not a number");
  const auto value = value_->get<double>();
  if (std::abs(value) > largest_number)
    refuse(fmt::format("is beyond ±{:g}, the largest number supported; choose other units",
                       largest_number));
  const bool above = allowed.is_open ? value > allowed.low : value >= allowed.low;
  if (above && allowed.is_open && allowed.low == 0 && value < least_positive)
    refuse(fmt::format("is below {:g}, the least positive number supported; choose other units",
                       least_positive));
  if (above && value <= allowed.high) return value;
  if (allowed.high < HUGE_VAL)
    refuse(fmt::format("is not within {} … {}", allowed.low, allowed.high));
  refuse(fmt::format("is not {} {}", allowed.is_open ? "above" : "at least", allowed.low));
}

std::int64_t Node::whole(std::int64_t low, std::int64_t high) const {
  const double value = value_->is_number() ? value_->get<double>() : NAN;  // 1e6 is whole, too
  if (!(value == std::floor(value))) refuse("is not a whole number");
  if (value < static_cast<double>(low) || value > static_cast<double>(high))
    refuse(fmt::format("is not within {} … {}", low, high));
  return static_cast<std::int64_t>(value);
}

bool Node::is_yes_or_no() const {
  return value_->is_boolean();
}

bool Node::yes_or_no() const {
  if (!value_->is_boolean()) refuse("is neither true nor false");
  return value_->get<bool>();
}

std::string Node::text() const {
  if (!value_->is_string()) refuse("is not a text");
  return value_->get<std::string>();
}

std::size_t Node::word(const Words& words) const {
  const auto found =
      value_->is_string() ? std::ranges::find(words, value_->get<std::string>()) : words.end();
  if (found == words.end()) refuse(fmt::format("is not one of {}", fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

tess::dn::Vec3 Node::vector(const Interval& allowed) const {
  if (!value_->is_array() || value_->size() != 3) refuse("is not a list of three numbers");
  const std::vector<Node> of = items();
  return {of[0].number(allowed), of[1].number(allowed), of[2].number(allowed)};
}

bool Node::is_list() const {
  return value_->is_array();
}

std::vector<Node> Node::items(std::size_t least) const {
  if (!is_list()) refuse("is not a list");
  if (value_->size() < least) refuse(fmt::format("has fewer than {} items", least));
  std::vector<Node> out;
  for (const json& item : *value_)
    out.emplace_back(item, file_, fmt::format("{}[{}]", place_, out.size()));
  return out;
}

}  // namespace particles
