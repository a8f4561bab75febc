#include "m2m/weights_file.hpp"

#include "m2m/io/exodus/netcdf_header.hpp"
#include "m2m/io/exodus/netcdf_writer.hpp"
#include "m2m/io/file_bytes.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace tess::m2m {
namespace {

/// Finds and reads the lists of a weights file.
class WeightsReader {
 public:
  explicit WeightsReader(const std::string& path) : path_(path), file_(path) {
    const std::string_view bytes = file_.view();
    if (bytes.starts_with("\x89HDF"))
      fail(ErrorCode::bad_file, path, ": is NetCDF-4; convert it with nccopy -k cdf5");
    if (!bytes.starts_with("CDF"))
      fail(ErrorCode::bad_file, path, ": is no NetCDF file; give a weights file in ESMF's layout");
    header_ = read_netcdf_header(path, bytes);
  }

  [[nodiscard]] std::size_t n_bytes() const { return file_.view().size(); }
  [[nodiscard]] std::uint64_t length(std::string_view name) const {
    for (const NetcdfDimension& dimension : header_.dimensions)
      if (dimension.name == name) {
        if (dimension.length == 0)
          fail(ErrorCode::bad_file, path_, ": dimension ", name,
               " is the record dimension; fix it with ncks --fix_rec_dmn all");
        return dimension.length;
      }
    missing("dimension", name);
  }

  /// A list of n_s numbers of type int32, int64 or double. The header has checked that they are
  /// within the file.
  template <class T>
  [[nodiscard]] std::vector<T> list(std::string_view name) const {
    for (const NetcdfVariable& variable : header_.variables) {
      if (variable.name != name) continue;
      const bool right_type = std::is_floating_point_v<T>
                                  ? variable.type == 6
                                  : variable.type == 4 || variable.type == 10;
      if (variable.shape.size() != 1 || header_.dimensions[variable.shape[0]].name != "n_s" ||
          !right_type)
        fail(ErrorCode::bad_file, path_, ": variable ", name,
             " is not of the type or shape of a weights file in ESMF's layout; write it again");
      const std::size_t each = variable.type == 4 ? 4 : 8;
      std::vector<T> out(length("n_s"));
      const char* at = file_.view().data() + variable.begin;
      for (T& value : out) {
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < each; ++i)
          bits = bits << 8U | static_cast<unsigned char>(at[i]);
        at += each;
        if constexpr (std::is_floating_point_v<T>)
          value = std::bit_cast<double>(bits);
        else
          value = each == 4 ? static_cast<std::int32_t>(bits) : static_cast<T>(bits);
      }
      return out;
    }
    missing("variable", name);
  }

 private:
  [[noreturn]] void missing(const char* what, std::string_view name) const {
    fail(ErrorCode::bad_file, path_, ": has no ", what, " ", name,
         "; give a weights file in ESMF's layout (n_a, n_b, n_s, row, col, S)");
  }

  const std::string& path_;
  FileBytes file_;
  NetcdfHeader header_;
};

void check_sizes_fit(std::int64_t n_columns, std::int64_t n_rows, const std::string& path,
                     const TetMesh& source, const TetMesh& target) {
  if (n_columns == static_cast<std::int64_t>(source.n_points()) &&
      n_rows == static_cast<std::int64_t>(target.n_points()))
    return;
  fail(ErrorCode::bad_value, path, ": holds weights from ", n_columns, " to ", n_rows,
       " vertices, but ", source.name, " has ", source.n_points(), " and ", target.name, " has ",
       target.n_points(), "; give the meshes that it was written for");
}

WeightMatrix read_matrix(const WeightsReader& file, const std::string& path) {
  const std::uint64_t n_columns = file.length("n_a"), n_rows = file.length("n_b");
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<VertexId>::max());
  if (n_columns > most || n_rows > most)
    fail(ErrorCode::bad_file, path, ": has ", n_columns, " source and ", n_rows,
         " target vertices; at most ", most, " are supported");
  const auto columns = file.list<std::int64_t>("col"), rows = file.list<std::int64_t>("row");
  const auto weights = file.list<double>("S");
  WeightMatrix matrix;
  matrix.n_columns = static_cast<std::int64_t>(n_columns);
  std::vector<std::uint64_t>& begin = matrix.rows.begin;
  begin.assign(n_rows + 1, 0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (rows[k] < 1 || rows[k] > static_cast<std::int64_t>(n_rows) || columns[k] < 1 ||
        columns[k] > matrix.n_columns || !std::isfinite(weights[k]))
      fail(ErrorCode::bad_value, path, ": weight ", k + 1, " of ", weights.size(), " is ",
           weights[k], " from vertex ", columns[k], " of ", n_columns, " to vertex ", rows[k],
           " of ", n_rows, "; write the file again");
    ++begin[static_cast<std::size_t>(rows[k])];
  }
  for (std::size_t row = 0; row < n_rows; ++row) begin[row + 1] += begin[row];
  std::vector<std::uint64_t> next(begin.begin(), begin.end() - 1);
  matrix.rows.columns.resize(weights.size());
  matrix.rows.weights.resize(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const std::uint64_t to = next[static_cast<std::size_t>(rows[k] - 1)]++;
    matrix.rows.columns[to] = static_cast<VertexId>(columns[k] - 1);
    matrix.rows.weights[to] = weights[k];
  }
  return matrix;
}

}  // namespace

void write_weights(const std::string& path, const WeightMatrix& matrix) {
  const Rows<double>& rows = matrix.rows;
  const std::size_t n = rows.weights.size();
  if (n == 0)
    fail(ErrorCode::bad_value, path,
         ": there are no weights to write, since no target vertex has a "
         "donor; check that the meshes overlap");
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  TESS_CHECK(matrix.n_columns > 0 && matrix.n_columns <= most && matrix.n_rows() <= most &&
                 rows.columns.size() == n && rows.begin.back() == n,
             "a matrix of ", matrix.n_rows(), " × ", matrix.n_columns, " with ", n,
             " weights is not in CSR form");
  NetcdfLayout layout;
  const auto n_a = static_cast<std::int32_t>(matrix.n_columns);
  const auto n_b = static_cast<std::int32_t>(matrix.n_rows());
  layout.dimensions = {{"n_a", static_cast<std::uint64_t>(n_a)},
                       {"n_b", static_cast<std::uint64_t>(n_b)},
                       {"n_s", n},
                       {"src_grid_rank", 1},
                       {"dst_grid_rank", 1}};
  layout.attributes = {{"title", "Tessera mesh transfer: target(row) = sum of S * source(col)"},
                       {"conventions", "NCAR-CSM"}};
  layout.variables = {{"src_grid_dims", 3, NetcdfType::int32},
                      {"dst_grid_dims", 4, NetcdfType::int32},
                      {"col", 2, NetcdfType::int32},
                      {"row", 2, NetcdfType::int32},
                      {"S", 2, NetcdfType::float64}};
  const bool is_large = n >= std::size_t{1} << 28U;
  NewFile file(path);
  file.write(netcdf_header(layout, is_large ? NetcdfVersion::cdf5 : NetcdfVersion::cdf2));
  write_big_endian(file, std::span(&n_a, 1));
  write_big_endian(file, std::span(&n_b, 1));
  std::vector<std::int32_t> ids;
  ids.reserve(n);
  for (const VertexId column : rows.columns) ids.push_back(column + 1);
  write_big_endian(file, std::span<const std::int32_t>(ids));
  ids.clear();
  for (std::size_t row = 0; row < rows.n_rows(); ++row)
    ids.insert(ids.end(), rows.begin[row + 1] - rows.begin[row],
               static_cast<std::int32_t>(row + 1));
  write_big_endian(file, std::span<const std::int32_t>(ids));
  write_big_endian(file, std::span(rows.weights));
  file.finish();
}

WeightMatrix read_weights(const std::string& path) {
  const WeightsReader file(path);
  // Rows without weights need no bytes in the file, but memory.
  constexpr std::uint64_t few = 1U << 24U, most_per_byte = 1000;
  const std::uint64_t n_rows = file.length("n_b");
  if (n_rows > few && n_rows / most_per_byte > file.n_bytes())
    fail(ErrorCode::bad_file, path, ": has ", n_rows, " target vertices in ", file.n_bytes(),
         " bytes; write the file again, or read it with the meshes that it is for");
  return read_matrix(file, path);
}

WeightMatrix read_weights(const std::string& path, const TetMesh& source, const TetMesh& target) {
  const WeightsReader file(path);
  check_sizes_fit(static_cast<std::int64_t>(file.length("n_a")),
                  static_cast<std::int64_t>(file.length("n_b")), path, source, target);
  return read_matrix(file, path);
}

void check_fits(const WeightMatrix& matrix, const std::string& path, const TetMesh& source,
                const TetMesh& target) {
  check_sizes_fit(matrix.n_columns, matrix.n_rows(), path, source, target);
}

void apply(const WeightMatrix& matrix, std::span<const double> values, std::size_t n_components,
           std::span<double> out) {
  const Rows<double>& rows = matrix.rows;
  TESS_CHECK(values.size() == static_cast<std::size_t>(matrix.n_columns) * n_components &&
                 out.size() == rows.n_rows() * n_components,
             "a matrix of ", matrix.n_rows(), " × ", matrix.n_columns, " got ", values.size(),
             " values and room for ", out.size(), " numbers of ", n_components, " components");
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    const std::span<const VertexId> columns = rows.columns_of(row);
    const std::span<const double> weights = rows.weights_of(row);
    double* const to = out.data() + row * n_components;
    for (std::size_t c = 0; c < n_components && !columns.empty(); ++c) {
      const auto value = [&](std::size_t k) {
        return values[static_cast<std::size_t>(columns[k]) * n_components + c];
      };
      const auto part = [&](std::size_t k) {  // as weighted() and interpolated() in locate.hpp
        const double product = weights[k] * value(k);
        return weights[k] == 0 && product != product ? 0 : product;
      };
      if (columns.size() == 4) {
        to[c] = (part(0) + part(1)) + (part(2) + part(3));
        continue;
      }
      double sum = weights[0] == 1 ? value(0) : part(0);
      for (std::size_t k = 1; k < columns.size(); ++k) sum += part(k);
      to[c] = sum;
    }
  }
}

}  // namespace tess::m2m
