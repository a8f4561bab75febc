// The sample of runtime/checkpoint.hpp and runtime/guide/checkpoint.md, compiled and run.
// tests/samples/check.py compares the text.
#include "runtime/checkpoint.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

namespace {

class Cell : public tess::Chare<Cell> {
 public:
  void step(tess::Callback<int> sum) { contribute(tess::sum, ++n_steps_ + index().x, sum); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_steps_);
  }

 private:
  int n_steps_ = 0;
};

struct State {
  tess::ArrayProxy<Cell> cells;
  int step = 0;
  int total = 0;
};

tess::Task relax(std::string folder, bool restarts, int last, int& result) {
  State state;
  if (restarts) {
    state = co_await tess::restart<State>(folder);
  } else {
    state.cells = tess::create<Cell>(tess::range(8));
  }
  while (state.step < last) {
    const int of_all = co_await state.cells.reduce<&Cell::step>();
    state.total += of_all;
    if (++state.step % 10 == 0) co_await tess::checkpoint(folder, state);
  }
  result = state.total;
}

int run_on_threads(int n_pes, const std::string& folder, bool restarts, int last) {
  int result = 0;
  tess::Setup setup{tess::make_threads_machine(n_pes), {}};
  REQUIRE(tess::run(setup, [&] { return relax(folder, restarts, last, result); }) == 0);
  return result;
}

}  // namespace

TEST_CASE("the sample of runtime/checkpoint.hpp gives the same total after a restart",
          "[runtime][sample]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  const int want = run_on_threads(2, scratch.path("other"), false, 40);
  CHECK(want == 8 * 40 * 41 / 2 + 40 * 28);
  run_on_threads(3, folder, false, 25);
  CHECK(run_on_threads(2, folder, true, 40) == want);
}
