#include "m2m/io/exodus/exodus_file.hpp"

#include "m2m/io/exodus/exodus_turn.hpp"
#include "m2m/io/exodus/netcdf_header.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <unistd.h>

namespace tess::m2m {
namespace {

/// Discards standard error while the object lives. libexodusII prints a message if it cannot open a
/// NetCDF-4 file, and has no option against it. The whole process is affected, so an object lives
/// only during one call.
class Silence {
 public:
  Silence() : kept_(::dup(STDERR_FILENO)) {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~Silence() {
    std::fflush(stderr);
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_;
};

}  // namespace

int read_exodus_axis(int id, std::size_t axis, std::int64_t first, std::span<double> out) {
  constexpr std::array names{"coordx", "coordy", "coordz"};
  std::array<std::size_t, 2> start{axis, static_cast<std::size_t>(first)}, count{1, out.size()};
  int variable = 0, rank = 0;
  const bool apart = nc_inq_varid(id, names[axis], &variable) == NC_NOERR;
  if (!apart)  // old files have one list
    if (const int code = nc_inq_varid(id, "coord", &variable); code != NC_NOERR) return code;
  if (const int code = nc_inq_varndims(id, variable, &rank); code != NC_NOERR) return code;
  if (rank != (apart ? 1 : 2)) return NC_EINVALCOORDS;
  const std::size_t skipped = apart ? 1 : 0;
  return nc_get_vara_double(id, variable, start.data() + skipped, count.data() + skipped,
                            out.data());
}

ExodusFile::ExodusFile(const std::string& path, std::string_view bytes)
    : path_(path),
      most_(static_cast<std::int64_t>(
          std::min<std::size_t>(bytes.size(), std::numeric_limits<std::int64_t>::max() / 1000) *
          (bytes.starts_with("CDF") ? 1 : 1000))) {
  const ExodusTurn turn;
  std::optional<Silence> silence;
  if (bytes.starts_with("CDF")) {
    check_netcdf_header(path, bytes);
  } else {
    silence.emplace();
  }
  ex_opts(0);  // the library prints no messages of its own
  int compute_bytes = sizeof(double);
  int stored_bytes = 0;
  float version = 0;
  id_ = ex_open(path.c_str(), EX_READ, &compute_bytes, &stored_bytes, &version);
  if (id_ < 0) damaged("ex_open", id_);
  ex_set_int64_status(id_, EX_ALL_INT64_API);
}

ExodusFile::~ExodusFile() {
  const ExodusTurn turn;
  ex_close(id_);
}

void ExodusFile::damaged(const char* call, int code) const {
  fail(ErrorCode::bad_file, path_, ": is truncated or damaged (", call, " failed with code ", code,
       "); write the mesh again");
}

std::int64_t ExodusFile::inquire(int what) const {
  const std::int64_t answer = ex_inquire_int(id_, what);
  if (answer < 0) damaged("ex_inquire", static_cast<int>(answer));
  return answer;
}

std::int64_t ExodusFile::count(int what, const char* name) const {
  const std::int64_t n = inquire(what);
  if (n > most_) damaged(name, -1);
  return n;
}

void ExodusFile::set_name_length() const {
  constexpr std::int64_t longest = 255;
  // The attribute maximum_name_length would have the length in use, but many writers leave it out.
  int dimension = 0;
  std::size_t length = 0;  // with a null byte
  if (nc_inq_dimid(id_, "len_name", &dimension) == NC_NOERR)
    check(nc_inq_dimlen(id_, dimension, &length), "nc_inq_dimlen");
  const auto n = static_cast<std::int64_t>(std::min<std::size_t>(length, longest + 1)) - 1;
  ex_set_max_name_length(id_, static_cast<int>(std::max<std::int64_t>(n, 32)));
}

std::vector<std::int64_t> ExodusFile::ids_of(ex_entity_type type, std::int64_t n) const {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(n));
  if (n > 0) {
    const std::string kind = type == EX_ELEM_BLOCK ? "eb" : type == EX_SIDE_SET ? "ss" : "ns";
    check_lengths(kind + "_prop1", {n});
    check_lengths(kind + "_status", {n});
    check(ex_get_ids(id_, type, ids.data()), "ex_get_ids");
  }
  std::vector<std::int64_t> sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    damaged("two blocks or sets with the same number", -1);
  return ids;
}

std::string ExodusFile::name_of(ex_entity_type type, std::int64_t id) const {
  std::array<char, 512> name{};
  if (ex_get_name(id_, type, id, name.data()) < 0) return {};  // an old file without names
  return name.data();
}

ExodusFile::ElementBlock ExodusFile::block_of(std::int64_t id, std::size_t k) const {
  ex_block block{};
  int at = 0;
  std::size_t length = 0;  // the library copies a type of any length
  if (nc_inq_varid(id_, fmt::format("connect{}", k).c_str(), &at) == NC_NOERR &&
      nc_inq_attlen(id_, at, "elem_type", &length) == NC_NOERR && length > sizeof block.topology)
    fail(ErrorCode::bad_file, path_, ": block ", id, " has an elem_type of ", length,
         " characters; at most ", MAX_STR_LENGTH, " are possible: write the mesh again");
  block.id = id;
  block.type = EX_ELEM_BLOCK;
  check(ex_get_block_param(id_, &block), "ex_get_block_param");
  block.topology[MAX_STR_LENGTH] = '\0';
  std::string type = block.topology;
  for (char& c : type) {
    c = std::isprint(static_cast<unsigned char>(c)) != 0
            ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
            : '?';
  }
  return {id, std::move(type), block.num_entry, block.num_nodes_per_entry};
}

std::optional<std::vector<std::int64_t>> ExodusFile::lengths_of(const std::string& variable) const {
  int at = 0, n_dimensions = 0;
  std::array<int, NC_MAX_VAR_DIMS> dimensions{};
  if (nc_inq_varid(id_, variable.c_str(), &at) != NC_NOERR) return std::nullopt;
  check(nc_inq_varndims(id_, at, &n_dimensions), "nc_inq_varndims");
  check(nc_inq_vardimid(id_, at, dimensions.data()), "nc_inq_vardimid");
  std::vector<std::int64_t> lengths;
  for (std::size_t d = 0; d < static_cast<std::size_t>(n_dimensions); ++d) {
    std::size_t length = 0;
    check(nc_inq_dimlen(id_, dimensions[d], &length), "nc_inq_dimlen");
    lengths.push_back(static_cast<std::int64_t>(length));
  }
  return lengths;
}

void ExodusFile::check_lengths(const std::string& variable,
                               const std::vector<std::int64_t>& lengths) const {
  const auto found = lengths_of(variable);
  if (found && *found != lengths)
    fail(ErrorCode::bad_file, path_, ": is truncated or damaged (variable ", variable,
         " has the lengths [", fmt::to_string(fmt::join(*found, ", ")), "] instead of [",
         fmt::to_string(fmt::join(lengths, ", ")), "]); write the mesh again");
}

void ExodusFile::check_shape(const std::string& variable, std::int64_t n) const {
  const auto lengths = lengths_of(variable);
  if (lengths && (lengths->size() != 2 || lengths->back() != n))
    fail(
        ErrorCode::bad_file, path_, ": variable ", variable, " is not ", n,
        " numbers per step, as ExodusII defines it; write each component as a variable of its own");
}

}  // namespace tess::m2m
