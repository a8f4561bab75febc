#include "apps/m2m_transfer/study/drift.hpp"

#include "tests/apps/m2m_transfer/program.hpp"

#include <algorithm>
#include <cmath>

using namespace tess;
using namespace m2m_transfer;
using tess::test::Scratch, tess::test::slurp;

namespace {

nlohmann::json rows_of(Setup&& setup, const std::string& chares) {
  const Scratch scratch;
  const std::string plots = scratch.path("plots");
  const nlohmann::json rows = tests::results_of(
      std::move(setup), {"kuhn:6@0.2", "kuhn:7@0.1", "--fields", "gaussian,1", "--chares", chares,
                         "--round-trips", "1,2,10", "--plot", plots});
  const std::string csv = slurp(plots + "/drift.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + static_cast<long>(rows.size()));
  return rows;
}

}  // namespace

TEST_CASE("round trips are ascending numbers", "[apps][drift]") {
  CHECK(parse_trips("1,2,50") == std::vector<std::int32_t>{1, 2, 50});
  for (const char* text : {"", "0", "1,1", "2,1", "1,x", "1.5", "1,"})
    CHECK_THROWS_WITH(parse_trips(text), Contains("--round-trips"));
}

TEST_CASE("the drift table is the same bit for bit on every machine", "[apps][drift]") {
  const nlohmann::json first = rows_of(tests::threads(1), "1");
  CHECK(rows_of(tests::threads(2), "6") == first);
  CHECK(rows_of(tests::simulated("pes=6,seed=3"), "16") == first);
  CHECK(rows_of(tests::simulated("pes=16,per-process=1,seed=5"), "16") == first);
}

TEST_CASE("each kind keeps in round trips what it promises to keep", "[apps][drift]") {
  const nlohmann::json rows = rows_of(tests::threads(2), "4");
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
