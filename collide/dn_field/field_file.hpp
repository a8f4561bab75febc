// Fields in files, flat and compressed: what was saved comes back bit for bit, and what is not such
// a file is refused.
//
//     magic 8 | version 4 | kind 4 | body bytes 8 | checksum 8 | body
//
// All numbers little-endian. The checksum covers the 24 bytes before it and the body; the body
// holds the field's numbers, then its arrays. Nothing is allocated that the file is too short for.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/field.hpp"

#include <iosfwd>
#include <string>

namespace tess::dn {

/// Writes `field` to `path`; a file of that name is replaced only once the new one is whole. Throws
/// Error(environment) where it cannot be written.
void save_field(const Field& field, const std::string& path);
void save_field(const CompressedField& field, const std::string& path);

/// Reads what save_field wrote. Throws Error(bad_file) naming the file and what is wrong with it:
/// cannot be opened, no field, another version, flat where compressed is asked for (and the other
/// way), truncated, longer than it says, damaged.
[[nodiscard]] Field load_field(const std::string& path);
[[nodiscard]] CompressedField load_compressed_field(const std::string& path);

/// The same from a stream that can be searched; `name` stands for it in errors.
[[nodiscard]] Field read_field(std::istream& file, const std::string& name);
[[nodiscard]] CompressedField read_compressed_field(std::istream& file, const std::string& name);

}  // namespace tess::dn
