// The sample of tasks that give values (runtime/task.hpp), compiled and run. tests/samples/check.py
// compares the text.
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

class Lake : public tess::Chare<Lake> {
 public:
  void level(tess::Callback<double> target) { contribute(tess::sum, 1.5 * index().x, target); }
};

tess::TaskOf<double> mean_level(tess::ArrayProxy<Lake> lakes) {
  const double of_all = co_await lakes.reduce<&Lake::level>();
  co_return of_all / static_cast<double>(lakes.size());
}

tess::Task measure(double& found) {
  const auto lakes = tess::create<Lake>(tess::range(5));
  const double mean = co_await mean_level(lakes);
  found = mean;
}

}  // namespace

TEST_CASE("the sample of runtime/task.hpp gives a mean", "[runtime][sample][task]") {
  double found = 0;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return measure(found); }) == 0);
  CHECK(found == 3);
}
