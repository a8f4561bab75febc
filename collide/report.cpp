#include "collide/report.hpp"

#include "runtime/core/error.hpp"

namespace tess::collide {
namespace {

constexpr int n_bits = 21;
constexpr std::uint64_t mask = (std::uint64_t{1} << n_bits) - 1;

}  // namespace

OwnerId owner_of(const Index3& index) {
  std::uint64_t bits = 0;
  for (const std::int32_t x : {index.x, index.y, index.z}) {
    if (x < -(1 << (n_bits - 1)) || x >= 1 << (n_bits - 1))
      fail(ErrorCode::bad_value, "owner_of: coordinate ", x,
           " of an index of three dimensions has more than ", n_bits,
           " bits; give a smaller one, or an index of one or two dimensions");
    bits = bits << n_bits | (static_cast<std::uint64_t>(static_cast<std::int64_t>(x)) & mask);
  }
  return static_cast<OwnerId>(bits);
}

void detail::set_index(Index3& index, OwnerId owner) {
  const auto bits = static_cast<std::uint64_t>(owner);
  const auto coordinate = [&](int place) {
    const auto x = static_cast<std::int32_t>(bits >> (place * n_bits) & mask);
    return x >> (n_bits - 1) != 0 ? x - (1 << n_bits) : x;
  };
  index = {coordinate(2), coordinate(1), coordinate(0)};
}

}  // namespace tess::collide
