// Arrays and groups that end leave no memory behind, as the system sees it.
#include "runtime/more/scoped.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/resident.hpp"

namespace {

class Block : public tess::Chare<Block> {
 public:
  void add(std::int64_t value) { value_ += value; }
  void sum(tess::Callback<std::int64_t> target) { contribute(tess::sum, value_, target); }

 private:
  std::int64_t value_ = 0;
};

class Member : public tess::Group<Member> {
 public:
  void pass(tess::ArrayProxy<Block> blocks, tess::Callback<void> done) {
    blocks[{pe().value}].send<&Block::add>(1);
    contribute(done);
  }
};

tess::Task use_both(std::int64_t& total) {
  const tess::Scoped blocks(tess::create<Block>(tess::range(8)));
  const tess::Scoped members(tess::create<Member>(tess::each_pe));
  tess::Future<void> passed;
  co_await tess::epoch([&] { members.broadcast<&Member::pass>(blocks, passed.callback()); });
  co_await passed;
  total += co_await blocks.reduce<&Block::sum>();
}

tess::Task use_both_often(tess::test::Growth& growth, std::int64_t& total) {
  for (int round = 1; round <= growth.n_rounds(); ++round) {
    co_await tess::epoch([&] { const tess::Task work = use_both(total); });
    growth.after(round);
  }
  CHECK(tess::n_collections() == 0);
}

TEST_CASE("twenty thousand arrays and groups that are created and dropped leave memory flat",
          "[runtime][destroy]") {
  tess::test::Growth growth(20'000);
  std::int64_t total = 0;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return use_both_often(growth, total); }) == 0);
  CHECK(total == 2 * 20'000);
  INFO("grows by " << growth.bytes() << " bytes from round 5000 to 20000");
  REQUIRE(growth.bytes() >= 0);
  CHECK(growth.bytes() < 1 << 20);
}

}  // namespace
