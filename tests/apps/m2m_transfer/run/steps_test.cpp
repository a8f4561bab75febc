// Graphs of meshes, and meshes that move, on several machines.
#include "apps/m2m_transfer/run/steps.hpp"

#include "apps/m2m_transfer/driver.hpp"
#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_vtu.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

using namespace tess;
using namespace m2m_transfer;
using tess::test::Scratch;
using tess::test::slurp;

namespace {

nlohmann::json pairs_of(Setup&& setup, DriverOptions options) {
  const Scratch scratch;
  options.json = scratch.path("report.json");
  REQUIRE(drive(setup, options) == 0);
  return nlohmann::json::parse(slurp(options.json))["pairs"];
}

Setup threads(int n) {
  return {make_threads_machine(n), {}};
}
Setup simulated(const char* keys) {
  return {make_simulated_machine(parse_simulated(keys)), {}};
}

DriverOptions options_of(const std::vector<std::string>& meshes, const std::string& pairs) {
  DriverOptions options;
  Request& request = options.request;
  request.source = meshes[0];
  request.target = meshes[1];
  request.more.assign(meshes.begin() + 2, meshes.end());
  request.pairs = pairs;
  request.fields = {"sin", "x*y"};
  request.policy = "nearest";
  return options;
}

/// All figures of the result, which depend on no machine.
std::vector<std::string> figures(const nlohmann::json& pairs) {
  std::vector<std::string> out;
  for (const auto& pair : pairs)
    for (const char* name :
         {"result_hash", "inside", "outside", "farthest", "l2", "rms", "linf", "found", "fields"})
      out.push_back(pair[name].dump());
  return out;
}

/// The same results on one thread, and on other machines with other numbers of parts.
nlohmann::json same_everywhere(DriverOptions options) {
  options.request.n_chares = 1;
  const nlohmann::json first = pairs_of(threads(1), options);
  options.request.n_chares = 6;
  CHECK(figures(pairs_of(threads(2), options)) == figures(first));
  options.request.n_chares = 16;
  CHECK(figures(pairs_of(simulated("pes=6,seed=2"), options)) == figures(first));
  CHECK(figures(pairs_of(simulated("pes=5,per-process=1,seed=7"), options)) == figures(first));
  return first;
}

}  // namespace

TEST_CASE("a graph has the same bits on every machine, step after step", "[apps][graph]") {
  auto options =
      options_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6@0.1", "kuhn:3"}, "A:B,A:C,B:D,C:D,D:A,B:C");
  options.request.steps = 3;
  const nlohmann::json pairs = same_everywhere(options);
  CHECK(pairs.size() == 6);
  for (const auto& pair : pairs) CHECK(pair["outside"] == 0);
}

TEST_CASE("a chain of pairs gives what transfers one by one give", "[apps][graph]") {
  const nlohmann::json chain =
      pairs_of(threads(2), options_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6"}, "A:B,B:C"));
  CHECK(chain[0]["result_hash"] ==
        pairs_of(threads(2), options_of({"kuhn:4@0.2", "kuhn:5"}, ""))[0]["result_hash"]);
  // The second pair reads what the first wrote: interpolated twice, so less exact.
  const nlohmann::json direct = pairs_of(threads(2), options_of({"kuhn:4@0.2", "kuhn:6"}, ""));
  CHECK(chain[1]["l2"].get<double>() > direct[0]["l2"].get<double>());
  // In the other order B is read first, so it starts with the formulas.
  const nlohmann::json other =
      pairs_of(threads(2), options_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6"}, "B:C,A:B"));
  CHECK(other[0]["result_hash"] != chain[1]["result_hash"]);
}

TEST_CASE("two pairs with one target give the second one's values, and both results are reported",
          "[apps][graph]") {
  const nlohmann::json both =
      pairs_of(threads(2), options_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6"}, "A:C,B:C"));
  CHECK(both[0]["result_hash"] ==
        pairs_of(threads(1), options_of({"kuhn:4@0.2", "kuhn:6"}, ""))[0]["result_hash"]);
  CHECK(both[0]["result_hash"] != both[1]["result_hash"]);
}

TEST_CASE("a pair that is overwritten is compared with the field that it moved", "[apps][graph]") {
  // A and B have moved apart, and the formula moves with each. Linear fields are exact.
  auto options = options_of({"kuhn:4", "kuhn:4", "kuhn:3"}, "A:C,B:C");
  options.request.fields = {"linear"};
  options.request.steps = 2;
  options.request.moves = {"A:translate(0.05,0,0)"};
  const nlohmann::json pairs = pairs_of(threads(2), options);
  CHECK(pairs[0]["outside"].get<int>() > 0);
  CHECK(pairs[0]["found"]["linf"].get<double>() < 1e-12);
  CHECK(pairs[1]["linf"].get<double>() < 1e-12);
}

TEST_CASE("the integral of the source is that of the values which the pair read", "[apps][graph]") {
  auto options = options_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6"}, "A:B,B:C,C:A");
  const auto source = [](const nlohmann::json& pair) {
    return pair["fields"][1]["integral"]["source"].get<double>();
  };
  const nlohmann::json cycle = pairs_of(threads(2), options);
  options.request.pairs = "A:B,B:C";  // without the pair that writes A later
  CHECK(source(cycle[0]) == source(pairs_of(threads(2), options)[0]));
  const double target = cycle[0]["fields"][1]["integral"]["target"].get<double>();
  CHECK(source(cycle[1]) == target);
}

TEST_CASE("a mesh that moves is searched again, with the same bits on every machine",
          "[apps][motion]") {
  auto options = options_of({"kuhn:6@0.2", "kuhn:5"}, "");
  options.request.steps = 4;
  options.request.moves = {"B:rotate(0,0,1,15deg)", "B:translate(0.05,0,0)"};
  const nlohmann::json pairs = same_everywhere(options);
  CHECK(pairs[0]["searches"] == 4);
  CHECK(pairs[0]["outside"].get<int>() > 0);
  CHECK(pairs[0]["seconds"]["search_again"].get<double>() > 0);
}

TEST_CASE("meshes that move together transfer as if they stood still", "[apps][motion]") {
  auto options = options_of({"kuhn:6@0.2", "kuhn:5"}, "");
  options.request.fields = {"linear"};
  options.request.steps = 5;
  // About a common point, so that both stay together; the formula moves with its mesh.
  options.request.moves = {"A:rotate(1,1,0,20deg,0,0,0)", "B:rotate(1,1,0,20deg,0,0,0)"};
  const Scratch scratch;
  options.picture = scratch.path("cut.svg");
  const nlohmann::json pairs = pairs_of(threads(2), options);
  CHECK(pairs[0]["linf"].get<double>() < 1e-12);
  const std::string picture = slurp(options.picture);
  const std::size_t last = picture.rfind("text-anchor=\"end\">");
  REQUIRE(last != std::string::npos);
  CHECK(std::stod(picture.substr(last + 18)) < 1e-12);  // the greatest error drawn
  options.picture.clear();
  // The target alone: the linear field is exact where it is found, at the new place.
  options.request.moves = {"B:translate(0.1,0.05,0)"};
  const nlohmann::json alone = pairs_of(threads(2), options);
  CHECK(alone[0]["outside"].get<int>() > 0);
  CHECK(alone[0]["found"]["linf"].get<double>() < 1e-12);
}

TEST_CASE("PE 0 holds a mesh only if it cannot be read in ranges, or Zoltan cuts it",
          "[apps][memory]") {
  const Scratch scratch;
  write_vtu(scratch.path("whole.vtu"), kuhn_mesh({3}), {});
  const auto held = [](const std::string& source, const std::string& partition) {
    Request request;
    request.source = source;
    request.target = "kuhn:4";
    request.partition = partition;
    Setup setup = threads(2);
    std::vector<bool> out;
    const auto load_it = [&]() -> Task {
      const Problem problem = co_await load(request);
      for (const RunMesh& mesh : problem.meshes) out.push_back(mesh.mesh.has_value());
    };
    REQUIRE(tess::run(setup, load_it) == 0);
    return out;
  };
  CHECK(held("kuhn:3", "curve") == std::vector{false, false});
  CHECK(held(scratch.path("whole.vtu"), "curve") == std::vector{true, false});
  CHECK(held("kuhn:3", "rcb") == std::vector{true, true});
}

TEST_CASE("a result has the points of the mesh as it moved, whether PE 0 held it or not",
          "[apps][memory]") {
  const Scratch scratch;
  auto options = options_of({"kuhn:4@0.2", "kuhn:5@0.1"}, "");
  options.request.steps = 3;
  options.request.moves = {"B:rotate(0,0,1,5deg)", "B:translate(0.01,0,0)"};
  for (const char* partition : {"curve", "rcb"}) {
    options.request.partition = partition;
    options.out = scratch.path(std::string(partition) + ".vtu");
    (void)pairs_of(threads(2), options);
  }
  CHECK(slurp(scratch.path("curve.vtu")) == slurp(scratch.path("rcb.vtu")));
  const TetMesh moved = read_mesh(scratch.path("curve.vtu")), start = kuhn_mesh({5, 0.1});
  REQUIRE(moved.n_points() == start.n_points());
  CHECK(moved.points.front() != start.points.front());
}

TEST_CASE("all parts of a .pvtu together have the result that one file has", "[apps][memory]") {
  const Scratch scratch;
  auto options = options_of({"kuhn:4@0.2", "kuhn:5@0.1"}, "");
  options.request.fields = {"sin", "x - 2*y"};
  options.request.steps = 2;
  options.request.moves = {"B:translate(0.1,0,0)"};
  options.request.n_chares = 5;
  options.request.kind = "second-order";
  for (const char* name : {"whole.vtu", "parts.pvtu"}) {
    options.out = scratch.path(name);
    (void)pairs_of(threads(2), options);
  }
  using Rows = std::map<Point, std::vector<double>>;
  const auto add = [](const std::string& path, Rows& rows) {
    const TetMesh mesh = read_mesh(path);
    const FieldFile file(path);
    std::vector<std::vector<double>> values;
    for (const char* name : {"sin", "x - 2*y", "status"})
      values.push_back(file.vertex_field(mesh, name, 0).values);
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      std::vector<double> row;
      for (const auto& field : values) row.push_back(field[v]);
      const auto [at, is_new] = rows.try_emplace(mesh.points[v], row);
      CHECK(at->second == row);  // every part that has the point has the same
    }
    return mesh.n_tets();
  };
  Rows whole, parts;
  const std::size_t n_tets = add(scratch.path("whole.vtu"), whole);
  std::size_t n_of_parts = 0;
  const std::string index = slurp(scratch.path("parts.pvtu"));
  for (int k = 0; k < 5; ++k) {
    const std::string name = "parts." + std::to_string(k) + ".vtu";
    CHECK(index.find("Source=\"" + name + "\"") != std::string::npos);
    n_of_parts += add(scratch.path(name), parts);
  }
  CHECK(index.find("parts.5.vtu") == std::string::npos);
  CHECK(n_of_parts == n_tets);
  CHECK(parts == whole);
  CHECK(std::ranges::any_of(whole, [](const auto& row) { return row.second[2] == 3; }));
}
