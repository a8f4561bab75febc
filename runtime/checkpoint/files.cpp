#include "runtime/checkpoint/files.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/core.h>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace tess::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "checkpoint-";
constexpr std::array<char, 8> magic{'T', 'E', 'S', 'S', 'C', 'K', 'P', 'T'};

struct Header {
  std::array<char, 8> kind = magic;
  std::uint32_t version = checkpoint_version;
  std::uint32_t zero = 0;
  std::uint64_t n_bytes = 0;
  std::uint64_t hash = 0;
};
static_assert(sizeof(Header) == 32);

[[noreturn]] void refuse(const std::string& path, const char* what) {
  fail(ErrorCode::environment, path, ": ", what, ": ", std::generic_category().message(errno));
}

/// An open file or folder.
class Open {
 public:
  Open(std::string path, int flags, const char* what)
      : path_(std::move(path)), file_(::open(path_.c_str(), flags | O_CLOEXEC, 0666)) {
    if (file_ < 0) refuse(path_, what);
  }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  ~Open() {
    if (file_ >= 0) ::close(file_);
  }

  void write(const void* data, std::size_t n) {
    const auto* at = static_cast<const char*>(data);
    while (n > 0) {
      const ssize_t done = ::write(file_, at, n);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) refuse(path_, "cannot be written");
      at += done;
      n -= static_cast<std::size_t>(done);
    }
  }
  /// Returns the number of bytes read: fewer than n at the end of the file only.
  std::size_t read(void* data, std::size_t n) {
    auto* at = static_cast<char*>(data);
    std::size_t all = 0;
    while (all < n) {
      const ssize_t done = ::read(file_, at + all, n - all);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) refuse(path_, "cannot be read");
      if (done == 0) break;
      all += static_cast<std::size_t>(done);
    }
    return all;
  }
  void write_at_begin(const void* data, std::size_t n) {
    if (::pwrite(file_, data, n, 0) != static_cast<ssize_t>(n)) refuse(path_, "cannot be written");
  }
  void sync() {
    if (::fsync(file_) != 0) refuse(path_, "cannot be made durable");
  }

 private:
  const std::string path_;
  const int file_;
};

void sync_folder(const std::string& path) {
  Open(path, O_RDONLY | O_DIRECTORY, "cannot be opened").sync();
}

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

/// Gives a file that was written beside its name.
void rename_beside(const std::string& path) {
  const std::string beside = path + ".part";
  if (std::rename(beside.c_str(), path.c_str()) != 0) refuse(beside, "cannot be renamed");
}

/// The hash of a file goes on from block to block; only the last block may be shorter.
constexpr std::size_t block_bytes = std::size_t{1} << 20U;
std::uint64_t next_hash(std::uint64_t hash, std::span<const std::byte> block) {
  return mix(hash ^ hash_bytes(block.data(), block.size()));
}
std::uint64_t hash_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0;
  for (std::size_t done = 0; done < bytes.size(); done += block_bytes)
    hash = next_hash(hash, bytes.subspan(done, std::min(block_bytes, bytes.size() - done)));
  return hash;
}

}  // namespace

class FileWriter::File {
 public:
  explicit File(std::string path)
      : path_(std::move(path)),
        open_(path_ + ".part", O_WRONLY | O_CREAT | O_TRUNC, "cannot be written") {}
  Open& open() { return open_; }
  void finish() {
    open_.sync();
    rename_beside(path_);
  }

 private:
  const std::string path_;
  Open open_;
};

FileWriter::FileWriter(const std::string& folder, const std::string& name)
    : file_(std::make_unique<File>(folder + "/" + name)), sum_{name, 0, 0} {
  const Header header;
  file_->open().write(&header, sizeof header);
}

FileWriter::~FileWriter() = default;

void FileWriter::write_block(std::span<const std::byte> bytes) {
  sum_.n_bytes += bytes.size();
  sum_.hash = next_hash(sum_.hash, bytes);
  file_->open().write(bytes.data(), bytes.size());
}

void FileWriter::write_some(Buffer& bytes) {
  std::size_t done = 0;
  for (; bytes.size() - done >= block_bytes; done += block_bytes)
    write_block({bytes.data() + done, block_bytes});
  if (done == 0) return;
  std::memmove(bytes.data(), bytes.data() + done, bytes.size() - done);
  bytes.resize(bytes.size() - done);
}

FileSum FileWriter::finish(std::span<const std::byte> bytes) {
  for (std::size_t done = 0; done < bytes.size(); done += block_bytes)
    write_block(bytes.subspan(done, std::min(block_bytes, bytes.size() - done)));
  Header header;
  header.n_bytes = sum_.n_bytes;
  header.hash = sum_.hash;
  file_->open().write_at_begin(&header, sizeof header);
  file_->finish();
  return sum_;
}

FileSum sum_of(const std::string& name, std::span<const std::byte> bytes) {
  return {name, bytes.size(), hash_of(bytes)};
}

FileSum write_file(const std::string& folder, const std::string& name,
                   std::span<const std::byte> bytes) {
  return FileWriter(folder, name).finish(bytes);
}

void write_last(const std::string& folder, const std::string& name, const std::string& text) {
  sync_folder(folder);
  const std::string path = folder + "/" + name;
  {
    Open file(path + ".part", O_WRONLY | O_CREAT | O_TRUNC, "cannot be written");
    file.write(text.data(), text.size());
    file.sync();
  }
  rename_beside(path);
  sync_folder(folder);
}

std::string read_text(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  Open file(path, O_RDONLY, "cannot be opened");
  std::string all;
  std::array<char, 4096> some{};
  for (std::size_t n = 0; (n = file.read(some.data(), some.size())) != 0;)
    all.append(some.data(), n);
  return all;
}

bool has_file(const std::string& folder, const std::string& name) {
  return is_there(folder + "/" + name);
}

Buffer read_file(const std::string& folder, const FileSum& sum) {
  const std::string path = folder + "/" + sum.name;
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) fail(ErrorCode::bad_file, path, ": ", error.message());
  if (size != sum.n_bytes + sizeof(Header))
    fail(ErrorCode::bad_file, path, " has ", size, " bytes, but the manifest says ",
         sum.n_bytes + sizeof(Header));
  Open file(path, O_RDONLY, "cannot be opened");
  Header header;
  const std::size_t n_header = file.read(&header, sizeof header);
  if (n_header != sizeof header || header.kind != magic)
    fail(ErrorCode::bad_file, path, " is no file of a checkpoint");
  if (header.version != checkpoint_version)
    fail(ErrorCode::bad_file, path, " has version ", header.version, ", but this program reads ",
         checkpoint_version);
  Buffer bytes(sum.n_bytes);
  const std::size_t n = file.read(bytes.data(), bytes.size());
  if (n != sum.n_bytes || header.n_bytes != sum.n_bytes || header.hash != sum.hash ||
      header.zero != 0 || hash_of({bytes.data(), bytes.size()}) != sum.hash)
    fail(ErrorCode::bad_file, path, " is damaged: its checksum is not that of the manifest");
  return bytes;
}

std::string folder_of(const std::string& folder, std::uint64_t number) {
  return fmt::format("{}/{}{:06}", folder, prefix, number);
}

void make_folder(const std::string& path) {
  // Each folder that is made is a new entry of the one around it, which is synced for that. The last
  // one counts as new in any case: another process may make it at the same time.
  std::vector<fs::path> changed;
  fs::path at = fs::absolute(canonical(path));
  do {
    at = at.parent_path();
    changed.push_back(at);
  } while (!is_there(at) && at != at.parent_path());
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail(ErrorCode::environment, path, ": cannot be made: ", error.message());
  for (const fs::path& folder : changed) sync_folder(folder.string());
}

std::vector<std::uint64_t> numbers_in(const std::string& folder) {
  std::vector<std::uint64_t> numbers;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    const auto number = parse_number<std::uint64_t>(std::string_view(name).substr(prefix.size()));
    if (number) numbers.push_back(*number);
  }
  std::sort(numbers.rbegin(), numbers.rend());
  return numbers;
}

std::string canonical(const std::string& folder) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(fs::absolute(folder, error), error);
  return error ? folder : path.string();
}

bool is_complete(const std::string& folder, std::uint64_t number) {
  return has_file(folder_of(folder, number), "manifest.json");
}

void remove_checkpoint(const std::string& folder, std::uint64_t number) {
  const std::string path = folder_of(folder, number);
  std::error_code ignored;  // what cannot be removed is tried again after the next checkpoint
  fs::remove(path + "/manifest.json", ignored);
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("pe-") || name == "main" || name == "main.part" ||
        name == "manifest.json.part")
      files.push_back(entry.path());
  }
  for (const fs::path& file : files) fs::remove(file, ignored);
  fs::remove(path, ignored);
}

}  // namespace tess::detail
