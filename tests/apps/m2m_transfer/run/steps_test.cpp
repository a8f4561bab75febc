// Graphs of meshes, and meshes that move, on several machines.
#include "apps/m2m_transfer/run/steps.hpp"

#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_vtu.hpp"
#include "tests/apps/m2m_transfer/program.hpp"

#include <algorithm>
#include <map>
#include <string>

using namespace tess;
using namespace m2m_transfer;
using tess::test::Scratch, tess::test::slurp, tests::results_of, tests::simulated, tests::threads,
    tests::Words;

namespace {

/// The words for these meshes with two fields, so that a pair has two rows.
Words words_of(Words meshes, const std::string& pairs, const Words& more = {}) {
  if (!pairs.empty()) meshes.insert(meshes.end(), {"--pairs", pairs});
  meshes.insert(meshes.end(), {"--fields", "sin,x*y"});
  meshes.insert(meshes.end(), more.begin(), more.end());
  return meshes;
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// All figures of the result, which depend on no machine.
std::vector<std::string> figures(const nlohmann::json& rows) {
  std::vector<std::string> out;
  for (const auto& row : rows)
    for (const char* name :
         {"result_hash", "inside", "outside", "farthest", "l2", "rms", "linf", "found", "l2_found",
          "rms_found", "linf_found", "integral_source", "integral_target"})
      out.push_back(row[name].dump());
  return out;
}

/// The same results on one thread, and on other machines with other numbers of parts.
nlohmann::json same_everywhere(const Words& words) {
  const auto parts = [&](const char* n) { return with(words, {"--chares", n}); };
  const nlohmann::json first = results_of(threads(1), parts("1"));
  CHECK(figures(results_of(threads(2), parts("6"))) == figures(first));
  CHECK(figures(results_of(simulated("pes=6,seed=2"), parts("16"))) == figures(first));
  CHECK(figures(results_of(simulated("pes=5,per-process=1,seed=7"), parts("16"))) ==
        figures(first));
  return first;
}

}  // namespace

TEST_CASE("a graph has the same bits on every machine, step after step", "[apps][graph]") {
  const nlohmann::json rows =
      same_everywhere(words_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6@0.1", "kuhn:3"},
                               "A:B,A:C,B:D,C:D,D:A,B:C", {"--steps", "3"}));
  CHECK(rows.size() == 6 * 2);
  for (const auto& row : rows) CHECK(row["outside"] == 0);
}

TEST_CASE("a chain of pairs gives what transfers one by one give", "[apps][graph]") {
  const Words meshes{"kuhn:4@0.2", "kuhn:5", "kuhn:6"};
  const nlohmann::json chain = results_of(threads(2), words_of(meshes, "A:B,B:C"));
  CHECK(chain[0]["result_hash"] ==
        results_of(threads(2), words_of({"kuhn:4@0.2", "kuhn:5"}, ""))[0]["result_hash"]);
  // The second pair reads what the first wrote: interpolated twice, so less exact.
  const nlohmann::json direct = results_of(threads(2), words_of({"kuhn:4@0.2", "kuhn:6"}, ""));
  CHECK(chain[2]["l2"].get<double>() > direct[0]["l2"].get<double>());
  // In the other order B is read first, so it starts with the formulas.
  const nlohmann::json other = results_of(threads(2), words_of(meshes, "B:C,A:B"));
  CHECK(other[0]["result_hash"] != chain[2]["result_hash"]);
}

TEST_CASE("two pairs with one target give the second one's values, and both results are reported",
          "[apps][graph]") {
  const nlohmann::json both =
      results_of(threads(2), words_of({"kuhn:4@0.2", "kuhn:5", "kuhn:6"}, "A:C,B:C"));
  CHECK(both[0]["result_hash"] ==
        results_of(threads(1), words_of({"kuhn:4@0.2", "kuhn:6"}, ""))[0]["result_hash"]);
  CHECK(both[0]["result_hash"] != both[2]["result_hash"]);
}

TEST_CASE("a pair that is overwritten is compared with the field that it moved", "[apps][graph]") {
  // A and B have moved apart, and the formula moves with each. Linear fields are exact.
  const nlohmann::json rows =
      results_of(threads(2), {"kuhn:4", "kuhn:4", "kuhn:3", "--pairs", "A:C,B:C", "--fields",
                              "linear", "--steps", "2", "--move", "A:translate(0.05,0,0)"});
  CHECK(rows[0]["outside"].get<int>() > 0);
  CHECK(rows[0]["linf_found"].get<double>() < 1e-12);
  CHECK(rows[1]["linf"].get<double>() < 1e-12);
}

TEST_CASE("the integral of the source is that of the values which the pair read", "[apps][graph]") {
  const Words meshes{"kuhn:4@0.2", "kuhn:5", "kuhn:6"};
  const nlohmann::json cycle = results_of(threads(2), words_of(meshes, "A:B,B:C,C:A"));
  // Without the pair that writes A later.
  const nlohmann::json chain = results_of(threads(2), words_of(meshes, "A:B,B:C"));
  CHECK(cycle[1]["integral_source"] == chain[1]["integral_source"]);
  CHECK(cycle[3]["integral_source"] == cycle[1]["integral_target"]);
}

TEST_CASE("a mesh that moves is searched again, with the same bits on every machine",
          "[apps][motion]") {
  const nlohmann::json rows = same_everywhere(words_of(
      {"kuhn:6@0.2", "kuhn:5"}, "",
      {"--steps", "4", "--move", "B:rotate(0,0,1,15deg)", "--move", "B:translate(0.05,0,0)"}));
  CHECK(rows[0]["searches"] == 4);
  CHECK(rows[0]["outside"].get<int>() > 0);
  CHECK(rows[0]["search_again_seconds"].get<double>() > 0);
}

TEST_CASE("meshes that move together transfer as if they stood still", "[apps][motion]") {
  const Scratch scratch;
  const Words words{"kuhn:6@0.2", "kuhn:5", "--fields", "linear", "--steps", "5"};
  // About a common point, so that both stay together; the formula moves with its mesh.
  const nlohmann::json rows = results_of(
      threads(2),
      with(words, {"--move", "A:rotate(1,1,0,20deg,0,0,0)", "--move", "B:rotate(1,1,0,20deg,0,0,0)",
                   "--picture", scratch.path("cut.svg")}));
  CHECK(rows[0]["linf"].get<double>() < 1e-12);
  const std::string picture = slurp(scratch.path("cut.svg"));
  const std::size_t last = picture.rfind("text-anchor=\"end\">");
  REQUIRE(last != std::string::npos);
  CHECK(std::stod(picture.substr(last + 18)) < 1e-12);  // the greatest error drawn
  // The target alone: the linear field is exact where it is found, at the new place.
  const nlohmann::json alone =
      results_of(threads(2), with(words, {"--move", "B:translate(0.1,0.05,0)"}));
  CHECK(alone[0]["outside"].get<int>() > 0);
  CHECK(alone[0]["linf_found"].get<double>() < 1e-12);
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
  const Words words = words_of(
      {"kuhn:4@0.2", "kuhn:5@0.1"}, "",
      {"--steps", "3", "--move", "B:rotate(0,0,1,5deg)", "--move", "B:translate(0.01,0,0)"});
  for (const char* partition : {"curve", "rcb"})
    (void)results_of(threads(2), with(words, {"--partition", partition, "--out",
                                              scratch.path(std::string(partition) + ".vtu")}));
  CHECK(slurp(scratch.path("curve.vtu")) == slurp(scratch.path("rcb.vtu")));
  const TetMesh moved = read_mesh(scratch.path("curve.vtu")), start = kuhn_mesh({5, 0.1});
  REQUIRE(moved.n_points() == start.n_points());
  CHECK(moved.points.front() != start.points.front());
}

TEST_CASE("all parts of a .pvtu together have the result that one file has", "[apps][memory]") {
  const Scratch scratch;
  for (const char* name : {"whole.vtu", "parts.pvtu"})
    (void)results_of(threads(2), {"kuhn:4@0.2", "kuhn:5@0.1", "--fields", "sin,x - 2*y", "--steps",
                                  "2", "--move", "B:translate(0.1,0,0)", "--chares", "5", "--kind",
                                  "second-order", "--out", scratch.path(name)});
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
    CHECK_THAT(index, Contains("Source=\"" + name + "\""));
    n_of_parts += add(scratch.path(name), parts);
  }
  CHECK_THAT(index, !Contains("parts.5.vtu"));
  CHECK(n_of_parts == n_tets);
  CHECK(parts == whole);
  CHECK(std::ranges::any_of(whole, [](const auto& row) { return row.second[2] == 3; }));
}
