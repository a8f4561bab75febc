// The sample of runtime/sends.hpp, compiled and run. tests/samples/check.py compares the text.
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <vector>

namespace {

std::vector<int> searched;

class Searcher : public tess::Chare<Searcher> {
 public:
  void search(int state) {
    if (!stopped_) searched.push_back(state);
  }
  void stop() { stopped_ = true; }
  void begin(bool ends) {
    const auto searcher = array()[{1}];
    for (const int depth : {3, 1, 2}) {
      const int state = 10 * depth;
      searcher.with(tess::Priority{depth}).send<&Searcher::search>(state);  // the shallowest first
    }
    if (ends) searcher.with(tess::expedited).send<&Searcher::stop>();  // before all others
  }

 private:
  bool stopped_ = false;
};

}  // namespace

TEST_CASE("the sample of runtime/sends.hpp searches the shallowest state first",
          "[runtime][sample]") {
  for (const bool ends : {false, true}) {
    searched.clear();
    tess::Setup setup{tess::make_threads_machine(1), {}};
    REQUIRE(tess::run(setup, [&] {
              tess::create<Searcher>(tess::range(2))[{0}].send<&Searcher::begin>(ends);
            }) == 0);
    CHECK(searched == (ends ? std::vector<int>{} : std::vector<int>{10, 20, 30}));
  }
}
