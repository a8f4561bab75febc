#include "m2m/io/exodus/netcdf_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <type_traits>

namespace tess::m2m {
namespace {

void put(std::string& out, std::uint64_t value, std::size_t n_bytes) {
  for (std::size_t i = n_bytes; i-- > 0;) out.push_back(static_cast<char>(value >> 8U * i & 0xffU));
}

template <class T>
void write_swapped(NewFile& file, std::span<const T> numbers) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  std::array<Bits, 4096> chunk;
  while (!numbers.empty()) {
    const std::size_t n = std::min(numbers.size(), chunk.size());
    for (std::size_t i = 0; i < n; ++i) {
      const Bits bits = std::bit_cast<Bits>(numbers[i]);
      if constexpr (sizeof(T) == 8)
        chunk[i] = __builtin_bswap64(bits);
      else
        chunk[i] = __builtin_bswap32(bits);
    }
    file.write_numbers(std::span<const Bits>(chunk).first(n));
    numbers = numbers.subspan(n);
  }
}

}  // namespace

std::string netcdf_header(const NetcdfLayout& layout, NetcdfVersion version) {
  const std::size_t count_bytes = version == NetcdfVersion::cdf5 ? 8 : 4;
  std::string out;
  const auto count = [&](std::uint64_t n) { put(out, n, count_bytes); };
  const auto word = [&](std::uint64_t n) { put(out, n, 4); };
  const auto text = [&](const std::string& bytes) {
    count(bytes.size());
    out += bytes;
    out.resize((out.size() + 3) / 4 * 4, '\0');
  };
  const auto list = [&](std::uint64_t tag, std::size_t n) {
    word(n == 0 ? 0 : tag);
    count(n);
  };
  const auto bytes_of = [&](const NetcdfLayout::Variable& variable) {
    const std::uint64_t each = variable.type == NetcdfType::float64 ? 8 : 4;
    return layout.dimensions[variable.dimension].second * each;
  };
  out = "CDF";
  out.push_back(static_cast<char>(version));
  count(0);  // records
  list(10, layout.dimensions.size());
  for (const auto& [name, length] : layout.dimensions) {
    text(name);
    count(length);
  }
  list(12, layout.attributes.size());
  for (const auto& [name, value] : layout.attributes) {
    text(name);
    word(2);  // characters
    text(value);
  }
  list(11, layout.variables.size());
  std::size_t header_bytes = out.size();
  for (const auto& variable : layout.variables)
    header_bytes += 4 * count_bytes + (variable.name.size() + 3) / 4 * 4 + 4 + count_bytes + 4 + 8;
  std::uint64_t begin = header_bytes;
  for (const auto& variable : layout.variables) {
    text(variable.name);
    count(1);
    count(variable.dimension);
    list(12, 0);
    word(static_cast<std::uint64_t>(variable.type));
    const std::uint64_t n_bytes = bytes_of(variable);
    count(version == NetcdfVersion::cdf5
              ? n_bytes
              : std::min<std::uint64_t>(n_bytes, std::numeric_limits<std::uint32_t>::max()));
    put(out, begin, 8);
    begin += n_bytes;
  }
  return out;
}

void write_big_endian(NewFile& file, std::span<const std::int32_t> numbers) {
  write_swapped(file, numbers);
}
void write_big_endian(NewFile& file, std::span<const double> numbers) {
  write_swapped(file, numbers);
}

}  // namespace tess::m2m
