// Fields in files. A field is loaded bit for bit as it was saved; any other file is refused.
//
//     magic 8 | version 4 | kind 4 | body bytes 8 | checksum 8 | body
//
// All numbers are little-endian. The checksum covers the 24 bytes before it and the body; the body
// holds the field's numbers and then its arrays. Memory is allocated only for what the file holds.
#pragma once

#include "collide/dn_field/field.hpp"

#include <iosfwd>
#include <string>

namespace tess::dn {

/// Writes `field` to `path`, and replaces a file of that name once the new one is complete. Throws
/// Error(environment) if it cannot be written, Error(bad_argument) for a compressed field.
void save_field(const Field& field, const std::string& path);

/// Reads a file of save_field. Throws Error(bad_file) naming the file and the fault: cannot be
/// opened, not a field, another version, truncated, longer than it says, damaged.
[[nodiscard]] Field load_field(const std::string& path);

/// Reads from a seekable stream; `name` is its name in errors.
[[nodiscard]] Field read_field(std::istream& file, const std::string& name);

}  // namespace tess::dn
