// Compression with brotli (RFC 7932), in memory. The format has no checksum: of damaged bytes, the
// reader of the text has to find what the decoder does not.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tess::balance {

[[nodiscard]] std::string pack_brotli(std::string_view text);

/// Throws Error that names the file if its bytes are truncated or damaged, or if their text is
/// longer than `most_bytes`. Needs no more memory than that, and 32 MiB for the decoder.
[[nodiscard]] std::string unpack_brotli(const std::string& file, std::string_view packed,
                                        std::size_t most_bytes);

}  // namespace tess::balance
