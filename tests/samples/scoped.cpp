// The sample of runtime/more/scoped.hpp, compiled and run. tests/samples/check.py compares the text.
#include "runtime/more/scoped.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

class Block : public tess::Chare<Block> {
 public:
  void add(int value) { value_ += value; }
  void sum(tess::Callback<int> target) { contribute(tess::sum, value_, std::move(target)); }

 private:
  int value_ = 1;
};

tess::Task add_up(int& result) {
  const tess::Scoped blocks(tess::create<Block>(tess::range(8)));
  blocks[{3}].send<&Block::add>(4);
  const int sum = co_await blocks.reduce<&Block::sum>();
  result = sum;
}

tess::Task add_up_and_count(int& result, std::size_t& n_left) {
  co_await tess::epoch([&] { const tess::Task work = add_up(result); });
  n_left = tess::n_collections();
}

}  // namespace

TEST_CASE("the sample of runtime/more/scoped.hpp adds up 12 and leaves no array behind",
          "[runtime][sample]") {
  int sum = 0;
  std::size_t n_left = 1;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return add_up_and_count(sum, n_left); }) == 0);
  CHECK(n_left == 0);
  CHECK(sum == 12);
}
