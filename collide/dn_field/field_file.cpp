#include "collide/dn_field/field_file.hpp"

#include "collide/dn_field/field/checksum.hpp"
#include "runtime/base/open_file.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <bit>
#include <concepts>
#include <filesystem>
#include <fstream>

namespace tess::dn {
namespace {
static_assert(std::endian::native == std::endian::little, "files are written as memory stands");

constexpr std::array<char, 8> magic{'T', 'e', 's', 's', 'D', 'N', '\r', '\n'};
constexpr std::uint32_t version = 3;
enum class Kind : std::uint32_t { flat = 1, compressed = 2 };

struct Head {
  std::array<char, 8> magic;
  std::uint32_t version, kind;
  std::uint64_t body_bytes, checksum;
};
static_assert(sizeof(Head) == 32);
constexpr std::size_t checked_head_bytes = 24;

const char* name_of(Kind kind) {
  return kind == Kind::flat ? "a flat field" : "a compressed field";
}

// Each pass over a field is the same list of its members: `pass` is given numbers and arrays.

template <class Pass, class Grid>
void each_of_grid(Pass& pass, Grid& grid) {
  pass.number(grid.origin.x), pass.number(grid.origin.y), pass.number(grid.origin.z);
  pass.number(grid.cell);
  for (auto& n : grid.n) pass.number(n);
}

template <class Pass>
void each_member(Pass& pass, auto& field)
  requires std::same_as<std::remove_const_t<std::remove_reference_t<decltype(field)>>, Field>
{
  each_of_grid(pass, field.grid);
  pass.number(field.method), pass.number(field.sides), pass.number(field.thickness);
  pass.number(field.jump), pass.number(field.surface);
  pass.array(field.distance), pass.array(field.normal);
}

template <class Pass>
void each_member(Pass& pass, auto& field)
  requires std::same_as<std::remove_const_t<std::remove_reference_t<decltype(field)>>,
                        CompressedField>
{
  each_of_grid(pass, field.grid);
  pass.number(field.method), pass.number(field.sides), pass.number(field.content);
  pass.number(field.thickness), pass.number(field.block_shift);
  for (auto& n : field.n_blocks) pass.number(n);
  pass.flag(field.layout.wide), pass.number(field.layout.normal_bits);
  pass.number(field.layout.step);
  pass.number(field.bound.distance), pass.number(field.bound.angle);
  pass.number(field.measured.distance), pass.number(field.measured.angle);
  pass.number(field.jump);
  pass.array(field.block), pass.array(field.entry);
}

std::span<const std::byte> bytes_of(const auto& value) {
  return std::as_bytes(std::span(&value, 1));
}

/// Gives every piece of the body, in order, to `visit`.
template <class Visit>
struct Pieces {
  const Visit& visit;
  void number(const auto& value) { visit(bytes_of(value)); }
  void flag(const bool& value) {
    const std::uint32_t word = value ? 1 : 0;
    visit(bytes_of(word));
  }
  void array(const auto& values) {
    const std::uint64_t size = values.size();
    visit(bytes_of(size));
    visit(std::as_bytes(std::span(values)));
  }
};

void for_each_piece(const auto& field, const auto& visit) {
  Pieces<std::remove_cvref_t<decltype(visit)>> pieces{visit};
  each_member(pieces, field);
}

void save(const auto& field, Kind kind, const std::string& path) {
  Head head{magic, version, static_cast<std::uint32_t>(kind), 0, 0};
  for_each_piece(field, [&](std::span<const std::byte> piece) { head.body_bytes += piece.size(); });
  Checksum checksum;
  checksum.add(bytes_of(head).first(checked_head_bytes));
  for_each_piece(field, [&](std::span<const std::byte> piece) { checksum.add(piece); });
  head.checksum = checksum.value();
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  const auto write = [&file](std::span<const std::byte> piece) {
    file.write(reinterpret_cast<const char*>(piece.data()),
               static_cast<std::streamsize>(piece.size()));
  };
  write(bytes_of(head));
  for_each_piece(field, write);
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (!file || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    fail(ErrorCode::environment, path, ": cannot be written (",
         error ? error.message() : "opening or writing failed",
         "); is the folder there, writable "
         "and not full?");
  }
}

/// Fills a field from the body, and sums it up on the way.
class FileReader {
 public:
  FileReader(std::istream& file, std::string path) : path_(std::move(path)), file_(file) {}

  void head(Kind wanted) {
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
    if (head.kind != static_cast<std::uint32_t>(wanted)) {
      const Kind other = wanted == Kind::flat ? Kind::compressed : Kind::flat;
      refuse(head.kind == static_cast<std::uint32_t>(other)
                 ? text("holds ", name_of(other), ", asked for was ", name_of(wanted))
                 : text("damaged: kind ", head.kind, " of field"));
    }
    const std::uint64_t body = size - sizeof(head);
    if (body != head.body_bytes)
      refuse(text(body < head.body_bytes ? "truncated" : "longer than it says", ": ", body,
                  " bytes behind its head, not ", head.body_bytes));
    if (const double there = usable_memory(); static_cast<double>(body) > there)
      fail(ErrorCode::environment, path_, ": holds ", static_cast<double>(body) / 1e9,
           " GB, and this process may have ", there / 1e9, " GB");
    left_ = head.body_bytes;
    expected_ = head.checksum;
    checksum_.add(bytes_of(head).first(checked_head_bytes));
  }
  void number(auto& value) { read(std::as_writable_bytes(std::span(&value, 1))); }
  void flag(bool& value) {
    std::uint32_t word = 0;
    number(word);
    value = word != 0;
  }
  template <class T>
  void array(std::vector<T>& values) {
    std::uint64_t size = 0;
    number(size);
    if (size > left_ / sizeof(T)) damaged();
    values.resize(size);
    read(std::as_writable_bytes(std::span(values)));
  }
  void finish() {
    if (left_ != 0 || checksum_.value() != expected_) damaged();
  }
  [[noreturn]] void refuse(const std::string& what) const {
    fail(ErrorCode::bad_file, path_, ": ", what);
  }
  [[noreturn]] void damaged() const {
    refuse("damaged: its checksum is not that of its contents; copy or save it again");
  }

 private:
  void read(std::span<std::byte> to) {
    if (to.size() > left_) damaged();
    file_.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    if (!file_) refuse("cannot be read");
    left_ -= to.size();
    checksum_.add(to);
  }

  std::string path_;
  std::istream& file_;
  std::uint64_t left_ = 0, expected_ = 0;
  Checksum checksum_;
};

void require(bool condition, const FileReader& reader, const char* what) {
  if (!condition) reader.refuse(text("holds a field that cannot be: ", what));
}

void require_sound(const FileReader& reader, const Grid& grid, Method method, Sides sides,
                   double thickness, float jump) {
  constexpr int most = 1 << 20;  // voxels along an axis: their number fits
  for (const int n : grid.n)
    require(n > 0 && n <= most, reader, "a grid without voxels, or of too many");
  require(grid.cell > 0 && std::isfinite(grid.cell) && is_finite(grid.origin), reader,
          "cells or an origin that are not finite");
  require(thickness > 0 && std::isfinite(thickness), reader,
          "a thickness that is not positive and finite");
  require(method <= Method::potential && sides <= Sides::two, reader, "an unknown method or side");
  require(jump >= 0, reader, "a jump that is negative or NaN");
}

/// That every voxel's entry is there: a file made by hand may have any checksum.
void require_sound(const FileReader& reader, const CompressedField& field) {
  const int e = field.block_shift;
  require(e >= 0 && e <= 4, reader, "blocks of another size");
  std::size_t n_blocks = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    require(field.n_blocks[a] == (field.grid.n[a] + (1 << e) - 1) >> e, reader,
            "blocks that do not cover the grid");
    n_blocks *= static_cast<std::size_t>(field.n_blocks[a]);
  }
  require(field.block.size() == n_blocks, reader, "another number of blocks");
  require(field.content <= Content::distance_and_normal, reader, "unknown content");
  require(field.layout.wide || (field.layout.normal_bits >= 1 && field.layout.normal_bits <= 15),
          reader, "entries of another layout");
  const std::size_t n_entries = field.entry.size() / (field.layout.wide ? 2 : 1);
  for (const std::uint32_t head : field.block) {
    const int s = static_cast<int>(head & 7U);
    require(s <= e && (head >> 3U) + (std::size_t{1} << (3 * (e - s))) <= n_entries, reader,
            "a block without entries");
  }
}

/// A field of a kind from its file, with all that both kinds have in common looked at.
template <class AnyField>
AnyField read(FileReader& reader, Kind kind) {
  AnyField field;
  reader.head(kind);
  each_member(reader, field);
  reader.finish();
  require_sound(reader, field.grid, field.method, field.sides, field.thickness, field.jump);
  return field;
}

}  // namespace

void save_field(const Field& field, const std::string& path) {
  save(field, Kind::flat, path);
}

void save_field(const CompressedField& field, const std::string& path) {
  save(field, Kind::compressed, path);
}

Field read_field(std::istream& file, const std::string& name) {
  FileReader reader(file, name);
  auto field = read<Field>(reader, Kind::flat);
  require(field.distance.size() == field.grid.size() &&
              (field.normal.empty() || field.normal.size() == field.grid.size()),
          reader, "another number of voxels");
  return field;
}

CompressedField read_compressed_field(std::istream& file, const std::string& name) {
  FileReader reader(file, name);
  auto field = read<CompressedField>(reader, Kind::compressed);
  require_sound(reader, field);
  return field;
}

Field load_field(const std::string& path) {
  std::ifstream file = open_file(path, "a field file");
  return read_field(file, path);
}

CompressedField load_compressed_field(const std::string& path) {
  std::ifstream file = open_file(path, "a field file");
  return read_compressed_field(file, path);
}

}  // namespace tess::dn
