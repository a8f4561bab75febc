// The samples of runtime/ask.hpp and runtime/more/when.hpp, compiled and run. tests/samples/check.py
// compares the text.
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <optional>
#include <string>
#include <vector>

using namespace std::chrono_literals;

namespace {

class Well : public tess::Chare<Well> {
 public:
  [[nodiscard]] double depth() { return 1.5 * index().x; }
  tess::Task slow() { co_await tess::sleep(1ms); }
  double never() { tess::fail(tess::ErrorCode::bad_value, "well ", index().x, " is dry"); }
};

struct Found {
  double one = 0, left = 0, right = 0;
  std::optional<double> in_time;
  std::string dry, late;
  std::vector<double> all;
  std::size_t first = 9;
};

tess::Task look(tess::ArrayProxy<Well> wells, Found& found) {
  const double depth = co_await wells[{5}].ask<&Well::depth>();
  found.one = depth;
  try {
    co_await wells[{3}].ask<&Well::never>();
  } catch (const tess::Error& error) {
    found.dry = error.what();
  }
  try {
    co_await wells[{2}].ask<&Well::slow>().within(5us);
  } catch (const tess::Error& error) {
    found.late = error.what();
  }
  const auto [left, right] =
      co_await tess::when_all(wells[{4}].ask<&Well::depth>(), wells[{6}].ask<&Well::depth>());
  found.left = left;
  found.right = right;
  const auto first = co_await tess::when_any(wells[{5}].ask<&Well::depth>(), tess::sleep(50ms));
  if (first.index() == 0) found.in_time = std::get<0>(first);

  std::vector<tess::Ask<Well, &Well::depth>> asks;
  for (int x = 0; x < 8; ++x) asks.push_back(wells[{x}].ask<&Well::depth>());
  found.all = co_await tess::when_all(std::move(asks));
  std::vector<tess::Sleep> times;
  for (const auto time : {3ms, 1ms, 2ms}) times.push_back(tess::sleep(time));
  found.first = (co_await tess::when_any(std::move(times))).index();
}

int simulate(std::function<tess::Task()> main) {
  return tests::run("pes=3,cost=100ns", std::move(main)).exit_code;
}

}  // namespace

TEST_CASE("the samples of awaited replies give values, errors, and the first of several",
          "[runtime][sample][ask]") {
  Found found;
  REQUIRE(simulate([&]() -> tess::Task {
            return look(tess::create<Well>(tess::range(8)), found);
          }) == 0);
  CHECK(found.one == 7.5);
  CHECK(found.dry == "well 3 is dry");
  CHECK(found.late.find("the reply of") != std::string::npos);
  CHECK(found.late.find("slow did not come within 0.005 ms") != std::string::npos);
  CHECK(found.left == 6);
  CHECK(found.right == 9);
  CHECK(found.in_time == 7.5);
  CHECK(found.all == std::vector<double>{0, 1.5, 3, 4.5, 6, 7.5, 9, 10.5});
  CHECK(found.first == 1);
}
