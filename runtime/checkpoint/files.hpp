// The files of checkpoints. A folder holds one folder per checkpoint:
//
//     FOLDER/checkpoint-000012/pe-0 … pe-7, main, manifest.json
//
// Each file is written under another name, made durable, and renamed; the manifest comes last. So a
// checkpoint with a manifest is complete, and a damaged file differs from what the manifest says.
//
//     | "TESSCKPT" | version | 0 | n_bytes | hash of the bytes | n_bytes bytes |
#pragma once

#include "runtime/core/buffer.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tess::detail {

/// What the manifest says of a file. The hash goes on from block to block of 1 MiB.
struct FileSum {
  std::string name;
  std::uint64_t n_bytes = 0;  ///< behind the header
  std::uint64_t hash = 0;     ///< of these bytes
};

inline constexpr std::uint32_t checkpoint_version = 6;

/// Writes a file piece by piece. All of these throw Error with the name of the file and what is
/// wrong.
class FileWriter {
 public:
  FileWriter(const std::string& folder, const std::string& name);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// Writes the bytes if they are many, and removes from `bytes` what was written.
  void write_some(Buffer& bytes);
  /// Writes the last bytes, makes the file durable, and gives it its name.
  [[nodiscard]] FileSum finish(std::span<const std::byte> bytes);

 private:
  class File;
  void write_block(std::span<const std::byte> bytes);

  const std::unique_ptr<File> file_;
  FileSum sum_;
};

/// What finish() returns for a file of these bytes.
[[nodiscard]] FileSum sum_of(const std::string& name, std::span<const std::byte> bytes);
/// Writes a file at once.
[[nodiscard]] FileSum write_file(const std::string& folder, const std::string& name,
                                 std::span<const std::byte> bytes);
/// Writes a file of text: it is there after a crash only if all that was written before is.
void write_last(const std::string& folder, const std::string& name, const std::string& text);
[[nodiscard]] std::string read_text(const std::string& folder, const std::string& name);
[[nodiscard]] bool has_file(const std::string& folder, const std::string& name);
/// The bytes of a file that is as the manifest says.
[[nodiscard]] Buffer read_file(const std::string& folder, const FileSum& sum);

/// The folder of a checkpoint.
[[nodiscard]] std::string folder_of(const std::string& folder, std::uint64_t number);
/// Makes the folder of a checkpoint, and those around it, durably.
void make_folder(const std::string& path);
/// The numbers of the checkpoints in a folder, the latest first, complete or not. None if there is
/// no such folder.
[[nodiscard]] std::vector<std::uint64_t> numbers_in(const std::string& folder);
/// One name for a folder, however it is written.
[[nodiscard]] std::string canonical(const std::string& folder);
/// True if a checkpoint has a manifest.
[[nodiscard]] bool is_complete(const std::string& folder, std::uint64_t number);
/// Removes a checkpoint: first its manifest, and no file of another kind.
void remove_checkpoint(const std::string& folder, std::uint64_t number);

}  // namespace tess::detail
