#include "apps/m2m_transfer/file_fields.hpp"

#include "apps/kit/worst.hpp"
#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/surface.hpp"
#include "m2m/write_exodus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>

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

/// Steps with `temp` at vertices, and `q` and `flux` in elements: linear functions of place times
/// step + 1, at the centroids.
std::string element_file(const Scratch& scratch, std::size_t n) {
  const std::string path = scratch.path("elements.exo");
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  ExodusSteps out(path, mesh);
  for (std::size_t step = 0; step < n; ++step) {
    const double factor = static_cast<double>(step) + 1;
    Field temp{"temp", 1, {}}, q{"q", 1, {}}, flux{"flux", 3, {}};
    for (const Point& p : mesh.points) temp.values.push_back(factor * p[0]);
    for (const Tet& tet : mesh.tets) {
      Point mean{};
      for (const VertexId v : tet)
        for (std::size_t k = 0; k < 3; ++k)
          mean[k] += mesh.points[static_cast<std::size_t>(v)][k] / 4;
      q.values.push_back(factor * (mean[0] - 2 * mean[2]));
      for (const double x : mean) flux.values.push_back(factor * x);
    }
    out.add(0.5 * factor, std::array{temp}, std::array{q, flux});
  }
  out.finish();
  return path;
}

FileFieldsReport moved(const FileFieldsRequest& request, std::int32_t n_pes = 2) {
  FileFieldsReport report;
  kit::Progress progress(nullptr);
  const auto main = [&]() -> Task { report = co_await move_file_fields(request, progress); };
  REQUIRE(tests::run_threads(n_pes, main).exit_code == 0);
  return report;
}

Task attempt(const FileFieldsRequest& request, std::string* message) {
  kit::Progress progress(nullptr);
  try {
    co_await move_file_fields(request, progress);
  } catch (const Error& error) {
    *message = error.what();
  }
}
std::string refusal(const FileFieldsRequest& request) {
  std::string message;
  REQUIRE(tests::run_threads(1, [&] { return attempt(request, &message); }).exit_code == 0);
  return message;
}

std::vector<std::uint64_t> hashes(const FileFieldsReport& report) {
  std::vector<std::uint64_t> out;
  for (const MovedStep& step : report.steps) out.push_back(step.result_hash);
  return out;
}

}  // namespace

TEST_CASE("vertices of no element are reported, and those that coincide in a transfer onto itself",
          "[apps][m2m]") {
  const Scratch scratch;
  const std::string path = scratch.path("spare.exo");
  TetMesh mesh = kuhn_mesh({2});
  mesh.points.push_back(mesh.points[0]);
  write_exodus(path, mesh, std::array{Field{"temp", 1, std::vector<double>(mesh.n_points(), 2)}});
  const auto shown = [&](const std::string& target) {
    FileFieldsRequest request;
    request.source = path;
    request.target = target;
    request.fields = {"temp"};
    const FileFieldsReport report = moved(request);
    return table(report) + kit::json_text(json_of(report));
  };
  const std::string unused = "in the source: 1 of 28 vertices belong to no element";
  const std::string coincident = "2 of 28 vertices have the place of another";
  CHECK_THAT(shown("kuhn:2"), Contains("unused       " + unused) && !Contains(coincident) &&
                                  !Contains("in the target"));
  CHECK_THAT(shown(path), Contains("in the target: 1 of 28 vertices belong to no element") &&
                              Contains("coincident   in the source: " + coincident) &&
                              Contains("\"coincident\": \"" + coincident));
}

TEST_CASE("a field that is called status is written beside the status of the vertices",
          "[m2m][driver]") {
  const Scratch scratch;
  FileFieldsRequest request;
  request.target = "kuhn:4";
  request.source = scratch.path("source.exo");
  const TetMesh mesh = kuhn_mesh({3, 0});
  ExodusSteps source(request.source, mesh);
  const std::vector<double> sevens(mesh.points.size(), 7);
  source.add(0, std::array{Field{"status", 1, sevens}, Field{"transfer_status", 1, sevens}});
  source.finish();
  for (const char* fields : {"status", "status,transfer_status"}) {
    INFO(fields);
    request.fields = {fields};
    request.out = scratch.path("out.exo");
    (void)moved(request);
    const FieldFile file(request.out);
    const TetMesh target = read_mesh(request.out);
    for (const double value : file.vertex_field(target, "status", 0).values)
      CHECK(value == Approx(7));
    const std::string own = std::string(fields) == "status" ? "" : "transfer_";
    for (const double value : file.vertex_field(target, own + "transfer_status", 0).values)
      CHECK(value <= 1);
  }
}

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

TEST_CASE("a vector of a file turns with its mesh, and other fields move with it",
          "[m2m][driver]") {
  const Scratch scratch;
  FileFieldsRequest request;
  request.source = scratch.path("rotor.exo");
  request.target = "kuhn:5";
  const TetMesh mesh = kuhn_mesh({3, 0.1});
  ExodusSteps out(request.source, mesh);
  Field temp{"temp", 1, {}}, v{"v", 3, {}};  // linear in place: exact on the target
  for (const Point& p : mesh.points) {
    temp.values.push_back(p[0]);
    v.values.insert(v.values.end(), {p[0], 2, 0});
  }
  for (const double time : {0.0, 1.0}) out.add(time, std::array{temp, v});
  out.finish();
  request.fields = {"temp,v", "x"};
  request.step = "all";
  request.steps = 2;  // quarter turns to the first step; one more to the second
  request.moves = {"A:rotate(0,0,1,60deg)", "A:rotate(0,0,1,30deg)"};
  request.out = scratch.path("out.exo");
  const auto worst = [&](const std::vector<std::string>& vectors, bool turns) {
    request.vectors = vectors;
    (void)moved(request);
    const FieldFile file(request.out);
    const TetMesh target = read_mesh(request.out);
    double error = 0;
    for (std::size_t step = 0; step < 2; ++step) {
      const Field there = file.vertex_field(target, "temp", step),
                  w = file.vertex_field(target, "v", step),
                  formula = file.vertex_field(target, "x", step);
      for (std::size_t i = 0; i < target.n_points(); ++i) {
        // The body's x where the point is: the body has made a quarter turn, or half a turn.
        const double x = step == 0 ? target.points[i][1] : 1 - target.points[i][0];
        std::array<double, 3> want{x, 2, 0};
        if (turns) want = step == 0 ? std::array{-2.0, x, 0.0} : std::array{-x, -2.0, 0.0};
        for (std::size_t c = 0; c < 3; ++c)
          error = std::max(error, std::abs(w.values[3 * i + c] - want[c]));
        error = std::max({error, std::abs(there.values[i] - x), std::abs(formula.values[i] - x)});
      }
    }
    return error;
  };
  CHECK(worst({"v"}, true) < 1e-13);
  CHECK(worst({}, false) < 1e-13);

  const auto refused = [&](auto change) {
    FileFieldsRequest other = request;
    change(other);
    return refusal(other);
  };
  CHECK_THAT(refused([](auto& r) { r.vectors = {"temp"}; }),
             Contains("--vector temp: the field has 1 component, and a vector has 3"));
  CHECK_THAT(refused([](auto& r) { r.vectors = {"w"}; }), Contains("--vector w is no field"));
  CHECK_THAT(refused([](auto& r) { r.moves = {"rotate(0,0,1,1)"}; }),
             Contains("'rotate(0,0,1,1)'"));
  CHECK_THAT(refused([](auto& r) { r.moves = {"translate(0,0,1)"}; }),
             Contains("moves the target, which stays with fields of files"));
  CHECK_THAT(refused([](auto& r) { r.moves.clear(); }),
             Contains("--steps 2 applies fields of files once"));
}

TEST_CASE("points that are watched have the values of every step, and none outside",
          "[m2m][driver]") {
  const Scratch scratch;
  constexpr std::size_t n = 20;
  FileFieldsRequest request;
  request.source = element_file(scratch, n);
  request.target = "kuhn:2";
  request.fields = {"temp", "max(y,z)"};
  request.step = "all";
  request.policy = "value:7";
  const std::vector<std::uint64_t> unwatched = hashes(moved(request));
  request.watch = {"0.3,0.4,0.5", "3,0,0.25", "1,1e-1,0"};
  request.watch_file = scratch.path("watched.csv");
  const FileFieldsReport report = moved(request);
  CHECK(hashes(report) == unwatched);
  CHECK(report.tally.counts[0] + report.tally.counts[1] == 27);
  REQUIRE(report.watched.size() == n * 3 * 2);
  for (std::size_t row = 0; row < report.watched.size(); ++row) {
    const Watched& one = report.watched[row];
    CHECK(one.field == (row % 2 == 0 ? "temp" : "max(y,z)"));
    CHECK(one.value.has_value() == (row / 2 % 3 != 1));
    if (one.value && row % 2 == 0)  // temp is x times twice the time
      CHECK(*one.value == Approx(2 * one.time * one.at[0]).epsilon(1e-13));
  }
  const std::string csv = test::slurp(request.watch_file);
  CHECK(csv.starts_with("time,x,y,z,field,value,status\n0.5,0.3,0.4,0.5,temp,0."));
  CHECK_THAT(
      csv,
      Contains("\n10,3,0,0.25,temp,,outside\n10,3,0,0.25,\"max(y,z)\",,outside\n10,1,0.1,0,temp,"));
  CHECK_THAT(csv, Contains("inside"));
  CHECK_THAT(table(report) + kit::json_text(json_of(report)),
             Contains("outside") && Contains("\"watched\": ["));
  request.fields = {"q"};
  CHECK_THAT(refusal(request), Contains("--fields names a field in elements"));
  request.fields = {"temp"};
  request.from_weights = "w.nc";
  CHECK_THAT(refusal(request), Contains("--watch does not work with --from-weights"));
}

TEST_CASE("fields of a file are carried over to a part of its mesh, and written as a series",
          "[m2m][driver]") {
  const Scratch scratch;
  FileFieldsRequest request;
  request.source = request.target = source_file(scratch);
  request.source_part = request.target_part = "skin";
  request.fields = {"temp,v"};
  request.kind = "nearest";
  request.step = "all";
  request.out = scratch.path("wall.pvd");
  const FileFieldsReport report = moved(request);
  CHECK(report.source == request.source + ":skin");
  CHECK(hashes(moved(request, 3)) == hashes(report));
  const TetMesh whole = read_mesh(request.source);
  const SurfaceMesh skin = skin_of(whole);
  const FieldFile source(request.source);
  for (const std::size_t step : {0U, 7U, 19U}) {
    const FieldFile file(scratch.path(fmt::format("wall.{}.vtu", step)));
    CHECK(file.times() == std::vector{0.5 * static_cast<double>(step)});
    for (const char* name : {"temp", "v"})
      CHECK(file.vertex_field(skin.mesh, name, 0).values ==
            rows_of(source.vertex_field(whole, name, step), skin.vertex_of_point).values);
  }
  CHECK(read_mesh(scratch.path("wall.19.vtu")).tets == skin.mesh.tets);
  request.target_part = "wet";
  CHECK_THAT(refusal(request), Contains("has no part 'wet': there are block 1, skin"));
  request.target_part.clear();
  request.target = scratch.path("wall.3.vtu");
  CHECK_THAT(refusal(request), Contains("wall.3.vtu, a step of --out, would overwrite TARGET"));
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
             Contains("source.exo: has no variable 'tmp' at vertices; it has: temp, v") &&
                 Contains("steps 0..19"));
  CHECK_THAT(changed([](auto& r) { r.step = "20"; }), Contains("has no step 20"));
  CHECK_THAT(changed([](auto& r) { r.step = "99999999999999999999"; }),
             Contains("--step 99999999999999999999 is no step"));
  CHECK_THAT(changed([](auto& r) { r.step = "-1"; }), Contains("--step -1 is no step"));
  CHECK_THAT(changed([](auto& r) { r.step = "last"; }), Contains("--step last is no step"));
  CHECK_THAT(changed([](auto& r) {
               r.step = "1";
               r.fields = {"sin"};
             }),
             Contains("--step 1 chooses a step of a field"));
  CHECK_THAT(changed([](auto& r) { r.from_weights = "none.nc"; }),
             Contains("none.nc: cannot be opened"));
  CHECK_THAT(changed([&](auto& r) {
               r.weights = scratch.path("w.nc");
               r.kind = "limited";
             }),
             Contains("kind limited has no weights"));
  CHECK_THAT(changed([](auto& r) {
               r.step = "all";
               r.out = "x.vtu";
             }),
             Contains("VTU holds one step"));
  FileFieldsRequest formula = good;
  formula.fields = {"x + y"};
  CHECK_FALSE(is_for_files(formula));
  formula.fields = {"tmp"};
  CHECK(is_for_files(formula));
  formula.source = "kuhn:3";
  CHECK_FALSE(is_for_files(formula));
}

TEST_CASE("fields in elements are moved to elements at all steps, and written as such",
          "[m2m][driver]") {
  const Scratch scratch;
  constexpr std::size_t n = 20;
  FileFieldsRequest request;
  request.source = element_file(scratch, n);
  request.target = "kuhn:5@0.1";
  request.fields = {"q,temp", "flux"};
  request.step = "all";
  CHECK(is_for_files(request));
  for (const char* kind : {"second-order", "conservative"}) {
    INFO(kind);
    request.kind = kind;
    request.out = scratch.path("out.exo");
    const FileFieldsReport report = moved(request);
    CHECK(report.fields ==
          std::vector<std::string>{"temp", "q (in elements)", "flux (3 components) (in elements)"});
    CHECK(report.cell_tally.counts[0] + report.cell_tally.counts[1] == 6 * 5 * 5 * 5);
    REQUIRE(report.steps.size() == n);
    CHECK(hashes(moved(request, 1)) == hashes(report));

    const TetMesh target = read_mesh(request.out);
    const FieldFile file(request.out);
    REQUIRE(file.n_steps() == n);
    for (const std::size_t step : {0U, 7U, 19U}) {
      CHECK(file.times()[step] == 0.5 * static_cast<double>(step + 1));
      const Field q = file.tet_field(target, "q", step),
                  flux = file.tet_field(target, "flux", step);
      double error = 0;
      for (std::size_t t = 0; t < target.n_tets(); ++t)
        kit::worsen(error,
                    std::abs(q.values[t] - (flux.values[3 * t] - 2 * flux.values[3 * t + 2])));
      for (std::size_t t = 0; t < target.n_tets(); ++t) {
        double x = 0;
        for (const VertexId v : target.tets[t])
          x += target.points[static_cast<std::size_t>(v)][0] / 4;
        kit::worsen(error, std::abs(flux.values[3 * t] - static_cast<double>(step + 1) * x));
      }
      CHECK(error < 1e-11);
      std::uint64_t hash = result_hash(file.vertex_field(target, "temp", step).values);
      for (const Field& field : {q, flux}) hash = result_hash(field.values, hash);
      CHECK(hash == report.steps[step].result_hash);
      CHECK(file.tet_field(target, "status", step).values ==
            file.tet_field(target, "status", 0).values);
    }
  }

  request.fields = {"q"};
  request.step = "3";
  request.out = scratch.path("one.vtu");
  const FileFieldsReport one = moved(request);
  CHECK_FALSE(one.searched);
  const FieldFile file(request.out);
  CHECK(result_hash(file.tet_field(read_mesh(request.out), "q", 0).values) ==
        one.steps[0].result_hash);
  CHECK_THAT(table(one), Contains("cells found"));
  CHECK(json_of(one).at("cells_inside").text() == std::to_string(one.cell_tally.counts[0]));

  request.out.clear();
  request.weights = scratch.path("w.nc");
  request.kind = "linear";
  CHECK_THAT(refusal(request), Contains("--fields names a field in elements"));
  request.weights.clear();
  request.policy = "nearest";
  CHECK_THAT(refusal(request), Contains("kind linear has no nearest cell"));
}
