#include "m2m/io/vtu/vtu_data.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <zlib.h>

namespace tess::m2m {
namespace {

/// 0 to 63; -1: a blank; -2: padding; -3: any other character.
constexpr std::array<std::int8_t, 256> make_digits() {
  std::array<std::int8_t, 256> digits{};
  digits.fill(-3);
  constexpr std::string_view alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    digits[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  for (const char blank : {' ', '\n', '\r', '\t'}) digits[static_cast<unsigned char>(blank)] = -1;
  digits[static_cast<unsigned char>('=')] = -2;
  return digits;
}
constexpr std::array<std::int8_t, 256> digits = make_digits();

/// The first bytes of an array, as far as they are there.
std::string first_bytes(std::string_view bytes, bool is_base64, std::size_t n) {
  return is_base64 ? from_base64(bytes, n) : std::string(bytes.substr(0, n));
}

std::uint64_t header(const std::string& bytes, std::size_t position, const VtuEncoding& encoding) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < encoding.header_bytes; ++i) {
    const std::size_t at = position * encoding.header_bytes +
                           (encoding.big_endian ? i : encoding.header_bytes - 1 - i);
    value = value << 8U | static_cast<unsigned char>(bytes[at]);
  }
  return value;
}

/// The blocks behind the headers.
std::optional<std::string> inflated(std::string_view bytes, bool is_base64,
                                    const VtuEncoding& encoding) {
  const std::size_t each = encoding.header_bytes;
  std::string start = first_bytes(bytes, is_base64, 3 * each);
  if (start.size() < 3 * each) return std::nullopt;
  const std::uint64_t n_blocks = header(start, 0, encoding);
  const std::uint64_t block_bytes = header(start, 1, encoding);
  const std::uint64_t last_bytes = header(start, 2, encoding);
  if (n_blocks == 0) return std::string{};
  if (n_blocks > bytes.size() / each) return std::nullopt;
  const std::size_t data_begin = (3 + n_blocks) * each;
  start = first_bytes(bytes, is_base64, data_begin);
  if (start.size() < data_begin) return std::nullopt;
  std::uint64_t packed_bytes = 0;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::uint64_t n = header(start, 3 + block, encoding);
    if (n > bytes.size() - packed_bytes) return std::nullopt;
    packed_bytes += n;
  }
  // zlib packs at most 1 032 bytes into one. The last block may be partial: its bytes count then,
  // not those of a block.
  const std::uint64_t most = 1100 * packed_bytes + 1024;
  const std::uint64_t n_full = last_bytes == 0 ? n_blocks : n_blocks - 1;
  if (last_bytes > block_bytes || last_bytes > most) return std::nullopt;
  if (n_full > 0 && block_bytes > most / n_full) return std::nullopt;
  const std::string packed = first_bytes(bytes, is_base64, data_begin + packed_bytes);
  if (packed.size() < data_begin + packed_bytes) return std::nullopt;
  const std::uint64_t n_bytes = n_full * block_bytes + last_bytes;
  std::string out(n_bytes, '\0');
  std::size_t from = data_begin, to = 0;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::uint64_t n_packed = header(start, 3 + block, encoding);
    const std::size_t n = std::min<std::size_t>(block_bytes, n_bytes - to);
    uLongf n_found = n;
    if (::uncompress(reinterpret_cast<Bytef*>(out.data() + to), &n_found,
                     reinterpret_cast<const Bytef*>(packed.data() + from),
                     static_cast<uLong>(n_packed)) != Z_OK ||
        n_found != n)
      return std::nullopt;
    from += n_packed;
    to += n;
  }
  return out;
}

}  // namespace

std::string from_base64(std::string_view text, std::size_t n_bytes) {
  std::string out;
  out.reserve(std::min(n_bytes, text.size()) + 3);
  std::uint32_t bits = 0;
  int n_digits = 0, n_padding = 0;
  for (const char c : text) {
    const int digit = digits[static_cast<unsigned char>(c)];
    if (digit == -1) continue;
    if (digit == -3 || (digit >= 0 && n_padding > 0)) break;
    bits = bits << 6U | (digit < 0 ? 0U : static_cast<std::uint32_t>(digit));
    n_padding += digit == -2 ? 1 : 0;
    if (++n_digits < 4) continue;
    for (int i = 0; i < 3 - n_padding; ++i)
      out.push_back(static_cast<char>(bits >> (16U - 8U * static_cast<unsigned>(i)) & 0xffU));
    bits = 0;
    n_digits = n_padding = 0;
    if (out.size() >= n_bytes) break;
  }
  return out;
}

std::optional<std::string> vtu_payload(std::string_view bytes, bool is_base64,
                                       const VtuEncoding& encoding) {
  if (encoding.zlib) return inflated(bytes, is_base64, encoding);
  const std::string start = first_bytes(bytes, is_base64, encoding.header_bytes);
  if (start.size() < encoding.header_bytes) return std::nullopt;
  const std::uint64_t n = header(start, 0, encoding);
  if (n > bytes.size()) return std::nullopt;
  std::string all = first_bytes(bytes, is_base64, encoding.header_bytes + n);
  if (all.size() < encoding.header_bytes + n) return std::nullopt;
  return all.substr(encoding.header_bytes, n);
}

}  // namespace tess::m2m
