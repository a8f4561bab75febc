// Checks that a type reads what it writes: packs a value, unpacks it, packs the copy, and compares.
// A difference is reported by its place in serialize() (or in the aggregate) and its type. Builds
// with TESS_CHECKS=all check the arguments of every message and every element that migrates (which
// is then rebuilt from its bytes on every machine); tests may check any type. serialize() may
// therefore be called although nothing migrates, so it must change only its archive and the members
// that it reads.
#pragma once

#include "runtime/core/algorithm.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/core/type_name.hpp"

#include <string>
#include <vector>

namespace tess {

namespace detail {

/// An archive that keeps the bytes and the type of each member separately.
class MemberWriter {
 public:
  static constexpr bool is_reading = false;
  struct Member {
    std::string_view type;
    std::vector<std::byte> bytes;
  };

  template <class... T>
  void operator()(const T&... values) {
    (members.push_back({name_of_type<T>, to_bytes(values)}), ...);
  }
  template <class Each>
  void numbers(std::span<const Each> values, const std::shared_ptr<const void>& /*keeper*/) {
    (*this)(std::vector<Each>(values.begin(), values.end()));
  }
  std::vector<Member> members;
};

/// Equal up to order: a hashed container may write equal contents in another order.
[[nodiscard]] inline bool same_bytes(std::vector<std::byte> a, std::vector<std::byte> b) {
  if (a == b) return true;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

template <class T>
[[nodiscard]] std::vector<MemberWriter::Member> members_of(const T& value) {
  MemberWriter members;
  if constexpr (serialization::HasSerialize<T>) {
    const_cast<T&>(value).serialize(members);
  } else if constexpr (serialization::TupleLike<T>) {
    std::apply(members, value);
  } else {
    members(value);
  }
  return std::move(members.members);
}

}  // namespace detail

/// Empty if the copy packs like the original; otherwise one line that names the first member that
/// differs.
template <class T>
[[nodiscard]] std::string difference(const T& original, const T& copy) {
  const auto before = detail::members_of(original), after = detail::members_of(copy);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (i < after.size() && detail::same_bytes(before[i].bytes, after[i].bytes)) continue;
    return text(plain_name(name_of_type<T>), ": member ", i + 1, " of ", before.size(), " (",
                before[i].type, ") does not come back as it was sent: ", before[i].bytes.size(),
                " bytes before, ", i < after.size() ? after[i].bytes.size() : 0, " after");
  }
  return {};
}

/// The same for a copy and the bytes that it was read from.
template <class T>
[[nodiscard]] std::string difference_from_bytes(std::span<const std::byte> sent, const T& copy) {
  const auto members = detail::members_of(copy);
  std::size_t at = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto mine = sent.subspan(at, std::min(members[i].bytes.size(), sent.size() - at));
    if (!detail::same_bytes({mine.begin(), mine.end()}, members[i].bytes))
      return text(plain_name(name_of_type<T>), ": member ", i + 1, " of ", members.size(), " (",
                  members[i].type, ") does not come back as it was sent");
    at += mine.size();
  }
  if (at != sent.size())
    return text(plain_name(name_of_type<T>), ": serialize() writes ", sent.size() - at,
                " bytes less after it has read than before");
  return {};
}

/// The same for a value and what is read from its own bytes.
template <class T>
[[nodiscard]] std::string round_trip_difference(const T& value) {
  const std::vector<std::byte> bytes = to_bytes(value);
  Reader read(bytes);
  T copy{};
  try {
    read(copy);
  } catch (const Error& error) {
    return text(plain_name(name_of_type<T>),
                ": serialize() reads more bytes than it writes: ", error.what());
  }
  if (read.remaining() != 0)
    return text(plain_name(name_of_type<T>), ": serialize() reads ", read.remaining(),
                " bytes less than it writes");
  return difference(value, copy);
}

}  // namespace tess
