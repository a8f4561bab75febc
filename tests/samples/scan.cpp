// The sample of runtime/more/scan.hpp, compiled and run. tests/samples/check.py compares the text.
#include "runtime/more/scan.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

/// Part of a point set: it numbers its points behind those of the parts before it.
class Part : public tess::Chare<Part> {
 public:
  explicit Part(int scale) : n_points_(scale * (index().x + 1)) {}
  tess::Task number_points(tess::Callback<std::vector<std::pair<tess::Index1, std::int64_t>>> all) {
    tess::Future<std::int64_t> first;
    contribute(tess::exclusive_scan(tess::sum, std::int64_t{0}), n_points_, first.callback());
    first_ = co_await first;
    contribute(tess::gather, first_, all);
  }

 private:
  std::int64_t n_points_;
  std::int64_t first_ = 0;
};

tess::Task number_points(std::vector<std::pair<tess::Index1, std::int64_t>>& found) {
  tess::Future<std::vector<std::pair<tess::Index1, std::int64_t>>> all;
  tess::create<Part>(tess::range(4), 10).broadcast<&Part::number_points>(all.callback());
  found = co_await all;
}

}  // namespace

TEST_CASE("the sample of scans numbers points part by part", "[runtime][sample][scan]") {
  std::vector<std::pair<tess::Index1, std::int64_t>> found;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return number_points(found); }) == 0);
  CHECK(found == std::vector<std::pair<tess::Index1, std::int64_t>>{
                     {{0}, 0}, {{1}, 10}, {{2}, 30}, {{3}, 60}});
}
