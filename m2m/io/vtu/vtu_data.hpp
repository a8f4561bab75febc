// The bytes of an array in a VTU file, out of base64 and zlib (VTK file formats, docs.vtk.org). An
// array is
//
//     [n bytes] data                                               not compressed
//     [n blocks] [block bytes] [bytes of the last] [bytes of each, compressed]… data   compressed
//
// in headers of 4 or 8 bytes each. With base64, headers and data may be encoded together or apart.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tess::m2m {

struct VtuEncoding {
  bool big_endian = false;
  bool zlib = false;
  std::size_t header_bytes = 4;
};

/// The first bytes that a base64 text stands for, at least `n_bytes` unless the text ends or has
/// other characters. Blanks do not count; padding may stand within.
[[nodiscard]] std::string from_base64(std::string_view text, std::size_t n_bytes);

/// The data of an array that begins with `bytes`, which may go on behind it. None if it is damaged.
[[nodiscard]] std::optional<std::string> vtu_payload(std::string_view bytes, bool is_base64,
                                                     const VtuEncoding& encoding);

}  // namespace tess::m2m
