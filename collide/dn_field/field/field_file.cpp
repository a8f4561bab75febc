#include "collide/dn_field/field_file.hpp"

#include "runtime/base/open_file.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <span>

namespace tess::dn {
namespace {
static_assert(std::endian::native == std::endian::little, "files are written as memory stands");

constexpr std::array<char, 8> magic{'T', 'e', 's', 's', 'D', 'N', '\r', '\n'};
constexpr std::uint32_t version = 4, flat = 1;

struct Head {
  std::array<char, 8> magic;
  std::uint32_t version, kind;
  std::uint64_t body_bytes, checksum;
};
static_assert(sizeof(Head) == 32);
constexpr std::size_t checked_head_bytes = 24;

/// The checksum over pieces of bytes: the hash is a bijection of each word, so that damage within
/// one word is always detected, and other damage is missed once in 2^64.
class Checksum {
 public:
  void add(std::span<const std::byte> bytes) {
    state_ = tess::mix(state_ ^ tess::hash_bytes(bytes.data(), bytes.size()));
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

std::span<const std::byte> bytes_of(const auto& value) {
  return std::as_bytes(std::span(&value, 1));
}

/// Visits the numbers and arrays of a field in the order of the file.
void each_member(auto& field, const auto& number, const auto& array) {
  auto& grid = field.grid;
  number(grid.origin.x), number(grid.origin.y), number(grid.origin.z), number(grid.cell);
  for (auto& n : grid.n) number(n);
  number(field.method), number(field.sides), number(field.thickness);
  number(field.jump), number(field.surface);
  array(field.distance), array(field.normal);
}

void each_piece(const Field& field, const auto& visit) {
  each_member(
      field, [&](const auto& value) { visit(bytes_of(value)); },
      [&](const auto& values) {
        const std::uint64_t size = values.size();
        visit(bytes_of(size));
        visit(std::as_bytes(std::span(values)));
      });
}

/// Reads the body and adds it to the checksum.
class FileReader {
 public:
  FileReader(std::istream& file, const std::string& path) : path_(path), file_(file) {}

  Field field() {
    head();
    Field field;
    each_member(
        field, [this](auto& value) { number(value); },
        [this]<class T>(std::vector<T>& values) {
          std::uint64_t size = 0;
          number(size);
          if (size > left_ / sizeof(T)) damaged();
          values.resize(size);
          read(std::as_writable_bytes(std::span(values)));
        });
    if (left_ != 0 || checksum_.value() != expected_) damaged();
    require_sound(field);
    return field;
  }

 private:
  void head() {
    file_.seekg(0, std::ios::end);
    const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(0, file_.tellg()));
    file_.seekg(0);
    Head head{};
    if (size < sizeof(head)) refuse("truncated: shorter than a field file's head");
    file_.read(reinterpret_cast<char*>(&head), sizeof(head));
    if (!file_) refuse("cannot be read");
    if (head.magic != magic) refuse("is no field file");
    if (head.version != version)
      refuse(
          text("has version ", head.version, ", this program reads ", version, "; save it again"));
    if (head.kind != flat) refuse(text("damaged: kind ", head.kind, " of field"));
    const std::uint64_t body = size - sizeof(head);
    if (body != head.body_bytes)
      refuse(text(body < head.body_bytes ? "truncated" : "longer than it says", ": ", body,
                  " bytes behind its head, not ", head.body_bytes));
    if (const double there = tess::detail::usable_memory(); static_cast<double>(body) > there)
      fail(ErrorCode::environment, path_, ": holds ", static_cast<double>(body) / 1e9,
           " GB, and this process may have ", there / 1e9, " GB");
    left_ = head.body_bytes;
    expected_ = head.checksum;
    checksum_.add(bytes_of(head).first(checked_head_bytes));
  }

  void require_sound(const Field& field) const {
    constexpr int most = 1 << 20;  // voxels along an axis: their number fits
    const auto require = [this](bool condition, const char* what) {
      if (!condition) refuse(text("holds a field that cannot be: ", what));
    };
    const Grid& grid = field.grid;
    for (const int n : grid.n) require(n > 0 && n <= most, "a grid without voxels, or of too many");
    require(grid.cell > 0 && std::isfinite(grid.cell) && is_finite(grid.origin),
            "cells or an origin that are not finite");
    require(field.thickness > 0 && std::isfinite(field.thickness),
            "a thickness that is not positive and finite");
    require(field.method <= Method::potential && field.sides <= Sides::two,
            "an unknown method or side");
    require(field.jump >= 0, "a jump that is negative or NaN");
    require(field.distance.size() == grid.size() &&
                (field.normal.empty() || field.normal.size() == grid.size()),
            "another number of voxels");
  }

  void number(auto& value) { read(std::as_writable_bytes(std::span(&value, 1))); }
  void read(std::span<std::byte> to) {
    if (to.size() > left_) damaged();
    file_.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    if (!file_) refuse("cannot be read");
    left_ -= to.size();
    checksum_.add(to);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    fail(ErrorCode::bad_file, path_, ": ", what);
  }
  [[noreturn]] void damaged() const {
    refuse("damaged: its checksum is not that of its contents; copy or save it again");
  }

  const std::string& path_;
  std::istream& file_;
  std::uint64_t left_ = 0, expected_ = 0;
  Checksum checksum_;
};

}  // namespace

void save_field(const Field& field, const std::string& path) {
  if (field.planes != nullptr)
    fail(ErrorCode::bad_argument, path, ": compressed fields are not saved; save the flat one");
  if (std::isinf(field.thickness))
    fail(ErrorCode::bad_argument, path, ": a field of thickness ", field.thickness,
         " is not saved; set the thickness that it holds for");
  Head head{magic, version, flat, 0, 0};
  each_piece(field, [&](std::span<const std::byte> piece) { head.body_bytes += piece.size(); });
  Checksum checksum;
  checksum.add(bytes_of(head).first(checked_head_bytes));
  each_piece(field, [&](std::span<const std::byte> piece) { checksum.add(piece); });
  head.checksum = checksum.value();
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  const auto write = [&file](std::span<const std::byte> piece) {
    file.write(reinterpret_cast<const char*>(piece.data()),
               static_cast<std::streamsize>(piece.size()));
  };
  write(bytes_of(head));
  each_piece(field, write);
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  fail(ErrorCode::environment, path, ": cannot be written (",
       error ? error.message() : "opening or writing failed",
       "); is the folder there, writable and not full?");
}

Field read_field(std::istream& file, const std::string& name) {
  return FileReader(file, name).field();
}

Field load_field(const std::string& path) {
  std::ifstream file = tess::detail::open_file(path, "a field file");
  return read_field(file, path);
}

}  // namespace tess::dn
