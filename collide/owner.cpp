#include "collide/owner.hpp"

#include "runtime/core/error.hpp"

namespace tess::collide {
namespace {

constexpr std::uint64_t one = 1, is_deep = one << 63U, is_flat = one << 62U;
constexpr int n_bits_flat = 31, n_bits_deep = 21;

std::uint64_t packed(std::int32_t x, int n_bits, const char* dimensions) {
  if (x < -(1 << (n_bits - 1)) || x > (1 << (n_bits - 1)) - 1)
    fail(ErrorCode::bad_value, "owner_of: coordinate ", x, " of an index of ", dimensions,
         " dimensions has more than ", n_bits,
         " bits; give a smaller one, or an index of fewer dimensions");
  return static_cast<std::uint32_t>(x) & ((one << n_bits) - 1);
}

/// The coordinate that begins at this bit.
std::int32_t coordinate(OwnerId owner, int n_bits, int at) {
  const int n_above = 64 - n_bits - at;
  return static_cast<std::int32_t>(
      static_cast<std::int64_t>(static_cast<std::uint64_t>(owner) << n_above) >> (64 - n_bits));
}

int dimensions_of(OwnerId owner) {
  const auto bits = static_cast<std::uint64_t>(owner);
  return (bits & is_deep) != 0 ? 3 : (bits & is_flat) != 0 ? 2 : bits >> 32U == 0 ? 1 : 0;
}

void require(OwnerId owner, int n_dimensions) {
  const int found = dimensions_of(owner);
  if (found == n_dimensions) return;
  fail(ErrorCode::bad_value, "the owner ", owner_text(owner), " is no element of an array of ",
       n_dimensions, n_dimensions == 1 ? " dimension" : " dimensions",
       ": give the array whose elements submitted the objects, and ids that owner_of() made");
}

}  // namespace

OwnerId owner_of(const Index2& index) {
  return static_cast<OwnerId>(is_flat | packed(index.x, n_bits_flat, "two") << n_bits_flat |
                              packed(index.y, n_bits_flat, "two"));
}

OwnerId owner_of(const Index3& index) {
  return static_cast<OwnerId>(is_deep | packed(index.x, n_bits_deep, "three") << 2 * n_bits_deep |
                              packed(index.y, n_bits_deep, "three") << n_bits_deep |
                              packed(index.z, n_bits_deep, "three"));
}

std::string owner_text(OwnerId owner) {
  switch (dimensions_of(owner)) {
    case 1:
      return index_text(index_of<Index1>(owner));
    case 2:
      return index_text(index_of<Index2>(owner));
    case 3:
      return index_text(index_of<Index3>(owner));
    default:
      return std::to_string(static_cast<std::uint64_t>(owner));
  }
}

void detail::set_index(Index1& index, OwnerId owner) {
  require(owner, 1);
  index.x = static_cast<std::int32_t>(static_cast<std::uint64_t>(owner));
}

void detail::set_index(Index2& index, OwnerId owner) {
  require(owner, 2);
  index = {coordinate(owner, n_bits_flat, n_bits_flat), coordinate(owner, n_bits_flat, 0)};
}

void detail::set_index(Index3& index, OwnerId owner) {
  require(owner, 3);
  index = {coordinate(owner, n_bits_deep, 2 * n_bits_deep),
           coordinate(owner, n_bits_deep, n_bits_deep), coordinate(owner, n_bits_deep, 0)};
}

}  // namespace tess::collide
