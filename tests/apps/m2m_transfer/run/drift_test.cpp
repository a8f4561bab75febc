#include "apps/m2m_transfer/run/drift.hpp"

#include "apps/m2m_transfer/driver.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace tess;
using namespace m2m_transfer;
using tess::test::message_of;
using tess::test::Scratch;
using tess::test::slurp;

namespace {

nlohmann::json rows_of(Setup&& setup, std::int32_t n_chares) {
  const Scratch scratch;
  DriverOptions options;
  options.request.source = "kuhn:6@0.2";
  options.request.target = "kuhn:7@0.1";
  options.request.fields = {"gaussian", "1"};
  options.request.n_chares = n_chares;
  options.round_trips = "1,2,10";
  options.json = scratch.path("drift.json");
  options.plot = scratch.path("plots");
  REQUIRE(drive(setup, options) == 0);
  const std::string csv = slurp(options.plot + "/drift.csv");
  const nlohmann::json rows = nlohmann::json::parse(slurp(options.json))["rows"];
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + static_cast<long>(rows.size()));
  return rows;
}

}  // namespace

TEST_CASE("round trips are ascending numbers", "[apps][drift]") {
  CHECK(parse_trips("1,2,50") == std::vector<std::int32_t>{1, 2, 50});
  for (const char* text : {"", "0", "1,1", "2,1", "1,x", "1.5", "1,"})
    CHECK_THAT(message_of([&] { (void)parse_trips(text); }), Catch::Contains("--round-trips"));
}

TEST_CASE("the drift table is the same bit for bit on every machine", "[apps][drift]") {
  const nlohmann::json first = rows_of({make_threads_machine(1), {}}, 1);
  CHECK(rows_of({make_threads_machine(2), {}}, 6) == first);
  CHECK(rows_of({make_simulated_machine(parse_simulated("pes=6,seed=3")), {}}, 16) == first);
  CHECK(rows_of({make_simulated_machine(parse_simulated("pes=16,per-process=1,seed=5")), {}}, 16) ==
        first);
}

TEST_CASE("each kind keeps in round trips what it promises to keep", "[apps][drift]") {
  const nlohmann::json rows = rows_of({make_threads_machine(2), {}}, 4);
  CHECK(rows.size() == all_transfer_kinds.size() * 3 * 2);
  for (const auto& row : rows) {
    INFO(row.dump());
    const auto kind = row["kind"].get<std::string>();
    const double change = std::abs(row["integral_change"].get<double>());
    if (row["field"] == "1") CHECK(row["linf"].get<double>() < 1e-11);  // constants are exact
    if (kind.starts_with("conservative")) CHECK(change < 1e-12);
    if (kind == "linear" && row["field"] == "gaussian" && row["trips"] == 10) {
      CHECK(change > 0.1);  // it smooths
      CHECK(row["l2_kept"].get<double>() < 0.9);
    }
  }
}
