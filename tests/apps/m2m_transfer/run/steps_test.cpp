// Graphs of meshes, and meshes that move, on several machines.
#include "apps/m2m_transfer/run/steps.hpp"

#include "apps/m2m_transfer/driver.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <nlohmann/json.hpp>

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

std::vector<std::string> hashes(const nlohmann::json& pairs) {
  std::vector<std::string> out;
  for (const auto& pair : pairs) out.push_back(pair["result_hash"].get<std::string>());
  return out;
}

/// The same results on one thread, and on other machines with other numbers of parts.
nlohmann::json same_everywhere(DriverOptions options) {
  options.request.n_chares = 1;
  const nlohmann::json first = pairs_of(threads(1), options);
  options.request.n_chares = 6;
  CHECK(hashes(pairs_of(threads(2), options)) == hashes(first));
  options.request.n_chares = 16;
  CHECK(hashes(pairs_of(simulated("pes=6,seed=2"), options)) == hashes(first));
  CHECK(hashes(pairs_of(simulated("pes=5,per-process=1,seed=7"), options)) == hashes(first));
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
  const nlohmann::json pairs = pairs_of(threads(2), options);
  CHECK(pairs[0]["linf"].get<double>() < 1e-12);
  // The target alone: the linear field is exact where it is found, at the new place.
  options.request.moves = {"B:translate(0.1,0.05,0)"};
  const nlohmann::json alone = pairs_of(threads(2), options);
  CHECK(alone[0]["outside"].get<int>() > 0);
  CHECK(alone[0]["found"]["linf"].get<double>() < 1e-12);
}
