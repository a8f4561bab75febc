#include "apps/m2m_transfer/file_fields.hpp"

#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "runtime/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <cmath>

using namespace m2m_transfer;
using tess::test::Scratch;

namespace {

constexpr std::size_t n_steps = 20;  // of four components each: more than a batch

/// A mesh with fields `temp` and `v` at 20 steps.
std::string source_file(const Scratch& scratch) {
  const std::string path = scratch.path("source.exo");
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  ExodusSteps out(path, mesh);
  for (std::size_t step = 0; step < n_steps; ++step) {
    Field temp{"temp", 1, {}}, v{"v", 3, {}};
    for (const Point& p : mesh.points) {
      const double value = std::sin(p[0] + 3 * p[1] * static_cast<double>(step));
      temp.values.push_back(value);
      for (const double x : p) v.values.push_back(value * x);
    }
    out.add(0.5 * static_cast<double>(step), std::array{temp, v});
  }
  out.finish();
  return path;
}

FileFieldsReport moved(const FileFieldsRequest& request, std::int32_t n_pes = 2) {
  FileFieldsReport report;
  apps::Progress progress(nullptr);
  Setup setup{make_threads_machine(n_pes), {}};
  REQUIRE(run(setup, [&]() -> Task { return move_file_fields(request, progress, &report); }) == 0);
  return report;
}

Task attempt(const FileFieldsRequest& request, std::string* message) {
  apps::Progress progress(nullptr);
  FileFieldsReport report;
  try {
    co_await move_file_fields(request, progress, &report);
  } catch (const Error& error) {
    *message = error.what();
  }
}
std::string refusal(const FileFieldsRequest& request) {
  std::string message;
  Setup setup{make_threads_machine(1), {}};
  REQUIRE(run(setup, [&]() -> Task { return attempt(request, &message); }) == 0);
  return message;
}

std::vector<std::uint64_t> hashes(const FileFieldsReport& report) {
  std::vector<std::uint64_t> out;
  for (const MovedStep& step : report.steps) out.push_back(step.result_hash);
  return out;
}

}  // namespace

TEST_CASE("all steps of a file are moved, and by weights from a file with the same hashes",
          "[m2m][driver]") {
  const Scratch scratch;
  FileFieldsRequest request;
  request.source = source_file(scratch);
  request.target = "kuhn:5@0.1";
  request.fields = {"temp,v", "min(x,y)"};
  request.step = "all";
  request.out = scratch.path("out.exo");
  request.weights = scratch.path("w.nc");
  CHECK(is_for_files(request));
  const FileFieldsReport searched = moved(request);
  CHECK(searched.fields == std::vector<std::string>{"temp", "v (3 components)", "min(x,y)"});
  REQUIRE(searched.steps.size() == n_steps);
  CHECK(searched.steps[7].time == 3.5);
  CHECK(searched.n_weights > 500);
  CHECK(searched.steps[3].result_hash != searched.steps[4].result_hash);

  const TetMesh target = read_mesh(request.out);
  const FieldFile file(request.out);
  CHECK(file.n_steps() == n_steps);
  for (const std::size_t step : {0U, 7U, 19U}) {
    std::uint64_t hash = result_hash({});
    for (const char* name : {"temp", "v", "min(x,y)"})
      hash = result_hash(file.vertex_field(target, name, step).values, hash);
    CHECK(hash == searched.steps[step].result_hash);
  }

  request.from_weights = std::exchange(request.weights, {});
  request.out = scratch.path("by_weights.exo");
  const FileFieldsReport by_weights = moved(request, 1);
  CHECK(hashes(by_weights) == hashes(searched));
  CHECK_FALSE(by_weights.searched);
  CHECK(by_weights.n_without == 0);

  request = {};
  request.source = source_file(scratch);
  request.target = "kuhn:5@0.1";
  request.fields = {"temp,v,min(x,y)"};
  CHECK(hashes(moved(request)) == std::vector{searched.steps.back().result_hash});
  request.step = "7";
  request.out = scratch.path("one.vtu");
  CHECK(hashes(moved(request)) == std::vector{searched.steps[7].result_hash});
  CHECK(FieldFile(request.out).times() == std::vector{3.5});
}

TEST_CASE("fields, steps and weights that do not exist are refused by name", "[m2m][driver]") {
  const Scratch scratch;
  FileFieldsRequest good;
  good.source = source_file(scratch);
  good.target = "kuhn:2";
  good.fields = {"temp"};
  const auto changed = [&](auto change) {
    FileFieldsRequest request = good;
    change(request);
    return refusal(request);
  };
  CHECK_THAT(changed([](auto& r) { r.fields = {"tmp"}; }),
             Catch::Contains("source.exo: has no variable 'tmp' at vertices; it has: temp, v") &&
                 Catch::Contains("steps 0..19"));
  CHECK_THAT(changed([](auto& r) { r.step = "20"; }), Catch::Contains("has no step 20"));
  CHECK_THAT(changed([](auto& r) { r.step = "last"; }), Catch::Contains("--step last is no step"));
  CHECK_THAT(changed([](auto& r) {
               r.step = "1";
               r.fields = {"sin"};
             }),
             Catch::Contains("--step 1 chooses a step of a field"));
  CHECK_THAT(changed([](auto& r) { r.from_weights = "none.nc"; }),
             Catch::Contains("none.nc: cannot be opened"));
  CHECK_THAT(changed([&](auto& r) {
               r.weights = scratch.path("w.nc");
               r.kind = "limited";
             }),
             Catch::Contains("kind limited has no weights"));
  CHECK_THAT(changed([](auto& r) {
               r.step = "all";
               r.out = "x.vtu";
             }),
             Catch::Contains("VTU holds one step"));
  FileFieldsRequest formula = good;
  formula.fields = {"x + y"};
  CHECK_FALSE(is_for_files(formula));
  formula.fields = {"tmp"};
  CHECK(is_for_files(formula));
  formula.source = "kuhn:3";
  CHECK_FALSE(is_for_files(formula));
}
