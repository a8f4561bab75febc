#include "m2m/weights_file.hpp"

#include "m2m/io/exodus/netcdf_header.hpp"
#include "m2m/io/exodus/netcdf_writer.hpp"
#include "m2m/kuhn.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <random>

using namespace tess::m2m;
using tess::test::bits_of, tess::test::message_of, tess::test::Scratch, tess::test::slurp;

namespace {

/// Rows of 0, 1, 4 and 7 weights.
WeightMatrix some_matrix() {
  WeightMatrix matrix;
  matrix.n_columns = 50;
  std::mt19937_64 random(3);
  for (std::size_t row = 0; row < 40; ++row) {
    constexpr std::array sizes{0, 1, 4, 7};
    for (int k = 0; k < sizes[row % 4]; ++k)
      matrix.rows.add(static_cast<VertexId>(random() % 50),
                      row % 4 == 1 ? 1.0 : static_cast<double>(random()) * 0x1p-64 - 0.3);
    matrix.rows.end_row();
  }
  return matrix;
}

bool same(const WeightMatrix& a, const WeightMatrix& b) {
  return a.n_columns == b.n_columns && a.rows.begin == b.rows.begin &&
         a.rows.columns == b.rows.columns && bits_of(a.rows.weights) == bits_of(b.rows.weights);
}

/// The bytes of a weights file, from its header and lists.
std::string weights_bytes(NetcdfVersion version, const std::vector<std::int32_t>& rows,
                          const std::vector<std::int32_t>& columns,
                          const std::vector<double>& weights, const Scratch& scratch) {
  NetcdfLayout layout;
  layout.dimensions = {{"n_s", weights.size()}, {"n_a", 3}, {"n_b", 4}};
  layout.attributes = {{"title", "five!"}};
  layout.variables = {
      {"S", 0, NetcdfType::float64}, {"row", 0, NetcdfType::int32}, {"col", 0, NetcdfType::int32}};
  const std::string path = scratch.path("raw.nc");
  NewFile file(path);
  file.write(netcdf_header(layout, version));
  write_big_endian(file, weights);
  write_big_endian(file, rows);
  write_big_endian(file, columns);
  file.finish();
  return slurp(path);
}

}  // namespace

TEST_CASE("weights are written and read back bit for bit", "[m2m][weights]") {
  const Scratch scratch;
  const std::string path = scratch.path("w.nc");
  const WeightMatrix matrix = some_matrix();
  write_weights(path, matrix);
  CHECK(scratch.n_files() == 1);
  CHECK(same(read_weights(path), matrix));
  const std::string bytes = slurp(path);
  const NetcdfHeader header = read_netcdf_header(path, bytes);
  CHECK(header.dimensions[0].name == "n_a");
  CHECK(header.dimensions[0].length == 50);
  CHECK(header.dimensions[1].length == 40);
  CHECK(header.dimensions[2].length == 120);
  CHECK(header.variables.back().begin + 120 * 8 == bytes.size());
}

TEST_CASE("rows of a file in any order keep the order of their columns, in both versions",
          "[m2m][weights]") {
  const Scratch scratch;
  for (const NetcdfVersion version : {NetcdfVersion::cdf2, NetcdfVersion::cdf5}) {
    const std::string path =
        scratch.write("foreign.nc", weights_bytes(version, {4, 1, 4, 1, 2}, {3, 2, 1, 1, 3},
                                                  {0.5, 0.25, -0.5, 0.75, 1}, scratch));
    const WeightMatrix matrix = read_weights(path);
    CHECK(matrix.n_columns == 3);
    CHECK(matrix.rows.begin == std::vector<std::uint64_t>{0, 2, 3, 3, 5});
    CHECK(matrix.rows.columns == std::vector<VertexId>{1, 0, 2, 2, 0});
    CHECK(matrix.rows.weights == std::vector<double>{0.25, 0.75, 1, 0.5, -0.5});
    std::vector<double> out(8, 9);
    apply(matrix, std::vector<double>{1, 10, 2, 20, 4, 40}, 2, out);
    CHECK(out == std::vector<double>{1.25, 12.5, 4, 40, 9, 9, 1.5, 15});
  }
}

TEST_CASE("a row of four is added in pairs, and a weight of 1 copies the bits", "[m2m][weights]") {
  WeightMatrix matrix;
  matrix.n_columns = 5;
  for (VertexId k = 0; k < 4; ++k) matrix.rows.add(k, 0.25);
  matrix.rows.end_row();
  matrix.rows.add(4, 1.0);
  matrix.rows.end_row();
  // With a weight of 1 among others, all of them count.
  for (VertexId k = 0; k < 4; ++k) matrix.rows.add(k, k == 0 ? 1.0 : 0.5);
  matrix.rows.end_row();
  const std::vector<double> values{1, 1e16, -1e16, 1, -0.0};
  std::vector<double> out(3);
  apply(matrix, values, 1, out);
  CHECK(out[0] == 0);  // from left to right it is 0.25
  CHECK(bits_of(out)[1] == bits_of(values)[4]);
  CHECK(out[2] == (1 + 5e15) + (-5e15 + 0.5));
}

TEST_CASE("weights that cannot be used are refused with their place", "[m2m][weights]") {
  const Scratch scratch;
  const auto refusal = [&](const std::string& bytes) {
    const std::string path = scratch.write("bad.nc", bytes);
    const std::string message = message_of([&] { (void)read_weights(path); });
    CHECK_THAT(message, Catch::StartsWith(path + ": "));
    return message;
  };
  const auto v = NetcdfVersion::cdf2;
  CHECK_THAT(refusal(weights_bytes(v, {5}, {1}, {1}, scratch)),
             Contains("weight 1 of 1 is 1 from vertex 1 of 3 to vertex 5 of 4"));
  CHECK_THAT(refusal(weights_bytes(v, {1, 1}, {1, 0}, {1, 1}, scratch)),
             Contains("weight 2 of 2 is 1 from vertex 0 of 3"));
  CHECK_THAT(refusal(weights_bytes(v, {1}, {1}, {std::nan("")}, scratch)),
             Contains("weight 1 of 1 is"));
  CHECK_THAT(refusal("\x89HDF\r\n"), Contains("is NetCDF-4; convert it"));
  CHECK_THAT(refusal("text"), Contains("is no NetCDF file"));
  NetcdfLayout other;
  other.dimensions = {{"n_s", 1}, {"n_a", 1}, {"n_b", 1}};
  CHECK_THAT(refusal(netcdf_header(other, v)), Contains("has no variable col"));
  other.dimensions.pop_back();
  CHECK_THAT(refusal(netcdf_header(other, v)), Contains("has no dimension n_b"));

  WeightMatrix empty;
  empty.n_columns = 3;
  empty.rows.end_row();
  CHECK_THROWS_WITH(write_weights(scratch.path("e.nc"), empty), Contains("no weights to write"));
  const TetMesh a = kuhn_mesh({1}), b = kuhn_mesh({2});
  CHECK_THROWS_WITH(check_fits(some_matrix(), "w.nc", a, b),
                    Contains("w.nc: holds weights from 50 to 40 vertices, but") &&
                        Contains("has 8 and") && Contains("has 27"));
}

TEST_CASE("weights whose number is unknown are refused", "[m2m][weights]") {
  const Scratch scratch;
  std::string bytes = weights_bytes(NetcdfVersion::cdf2, {}, {}, {}, scratch);
  const auto refusal = [&] {
    const std::string path = scratch.write("records.nc", bytes);
    return message_of([&] { (void)read_weights(path); });
  };
  CHECK_THAT(refusal(), Contains("dimension n_s is the record dimension"));
  bytes.replace(4, 4, 4, '\xff');
  CHECK_THAT(refusal(), Contains("the number of records is unknown"));
}

TEST_CASE("a weights file of more rows than it can hold or its meshes have is refused",
          "[m2m][weights]") {
  const Scratch scratch;
  std::string bytes = weights_bytes(NetcdfVersion::cdf2, {1}, {1}, {1}, scratch);
  const TetMesh source = kuhn_mesh({1}), target = kuhn_mesh({2});
  const auto of = [&](const char* dimension, std::uint32_t n) {
    const std::size_t at = bytes.find(dimension) + 4;  // after the name and its padding
    for (std::size_t i = 0; i < 4; ++i)
      bytes[at + i] = static_cast<char>(n >> (24 - 8 * i) & 0xffU);
  };
  of("n_a", 8);
  of("n_b", 27);
  std::string path = scratch.write("w.nc", bytes);
  CHECK(same(read_weights(path, source, target), read_weights(path)));
  CHECK_THROWS_WITH(read_weights(path, target, source),
                    Contains("holds weights from 8 to 27 vertices"));
  of("n_b", 2147483647);
  path = scratch.write("w.nc", bytes);
  CHECK_THROWS_WITH(read_weights(path), Contains("has 2147483647 target vertices in "));
  CHECK_THROWS_WITH(read_weights(path, source, target),
                    Contains("holds weights from 8 to 2147483647 vertices"));
}

TEST_CASE("weights files that are cut or have flipped bits give one line of error",
          "[m2m][weights]") {
  const Scratch scratch;
  const std::string path = scratch.path("w.nc");
  write_weights(path, some_matrix());
  const std::string bytes = slurp(path);
  tess::test::damage_everywhere("cut.nc", bytes, bytes.size() / 16, 2000,
                                [](const std::string& name) { (void)read_weights(name); });
}
