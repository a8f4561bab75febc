// Writing reports to files: whole, or an error that names the path and the reason.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kit {

/// The reason why a file cannot be written; empty if none is found without writing it.
[[nodiscard]] std::string hindrance(const std::filesystem::path& file);

/// Throws tess::Error (environment) that names the option, the path and the reason where a file
/// cannot be written: called before long work. An empty path is not checked.
void require_writable(const std::string& option, const std::string& path);

/// The same for a picture, NAME.svg, and its data.
void require_picture(const std::string& option, const std::string& path);

/// True if two paths lead to one file, or will once it is written. No path is the same as an empty
/// one.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws tess::Error (environment) that names the path and why it cannot be written.
void write_file(const std::string& path, std::string_view content);

/// Makes a folder to write to, and those above it. Throws tess::Error (environment) that names the
/// option, the path and the reason. An empty path makes no folder.
void make_folder(const std::string& option, const std::filesystem::path& path);

/// Where the data of a picture goes: NAME.csv for NAME.svg. Throws tess::Error (bad_argument) for a
/// path that does not end in .svg.
[[nodiscard]] std::string data_path(const std::string& svg_path);

}  // namespace kit
