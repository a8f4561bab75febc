// Epochs that are awaited with others.
#include "runtime/more/when.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace std::chrono_literals;

namespace {

struct Paper {
  int key = 0;
};

class Clerk : public tess::Chare<Clerk> {
 public:
  /// Files a paper and passes it on.
  void pass(int n_left) {
    ++n_filed_;
    if (n_left > 0) array()[{(index().x + 1) % 4}].send<&Clerk::pass>(n_left - 1);
  }
  tess::Task wait_for_paper() { (void)co_await papers_.take(9); }
  void give_paper() { papers_.put({9}); }
  [[nodiscard]] int n_filed() const { return n_filed_; }
  /// An epoch's body gives what is awaited with it.
  tess::Task read_own(tess::Callback<int> target) {
    const auto both =
        co_await tess::when_all(tess::epoch([this] { notes_.put({1}); }), notes_.take(1));
    tess::Future<int> unused;
    const auto first =
        co_await tess::when_any(tess::epoch([this] { notes_.put({2}); }), notes_.take(2), unused);
    const int left = static_cast<int>(notes_.size());
    target(std::get<1>(both).key + (first.index() == 1 ? 10 : 20) + left);
  }
  /// An error leaves what the others have got: the message that was there, that which came while
  /// they were awaited, and the future's result.
  tess::Task read_in_vain(tess::Callback<int> target) {
    tess::Future<int> there;
    there.callback()(5);
    notes_.put({3});
    try {
      (void)co_await tess::when_all(notes_.take(3), notes_.take(4), there, tess::epoch([this] {
                                      notes_.put({4});
                                      tess::fail(tess::ErrorCode::bad_value, "no");
                                    }));
    } catch (const tess::Error&) {
    }
    const int left = co_await there;
    target(10 * static_cast<int>(notes_.size()) + left);
  }
  void serialize(auto& ar) { ar(n_filed_, papers_, notes_); }

 private:
  int n_filed_ = 0;
  tess::Mailbox<&Paper::key> papers_, notes_;
};

struct Joined {
  int of_both = 0;
  std::size_t first = 9, at_once = 9;
  int after_first = 0, of_third = 0, own = 0, kept = 0, n_done = 0;
  bool ran = false;
  std::string error;
};

tess::Task count_later(int& n_done, bool fails) {
  co_await tess::sleep(1us);
  ++n_done;
  if (fails) tess::fail(tess::ErrorCode::bad_value, ", nor this");
}

tess::Task join(Joined& found) {
  const auto clerks = tess::create<Clerk>(tess::range(4));
  (void)co_await tess::when_all(tess::epoch([&] { clerks[{0}].send<&Clerk::pass>(11); }),
                                tess::epoch([&] { clerks[{2}].send<&Clerk::pass>(7); }),
                                clerks[{1}].ask<&Clerk::n_filed>());
  for (int x = 0; x < 4; ++x) {
    const int n = co_await clerks[{x}].ask<&Clerk::n_filed>();
    found.of_both += n;
  }
  // An epoch that takes longer than a deadline goes on.
  const auto first = co_await tess::when_any(
      tess::epoch([&] { clerks.broadcast<&Clerk::wait_for_paper>(); }), tess::sleep(1us));
  found.first = first.index();
  co_await tess::epoch([&] { clerks.broadcast<&Clerk::give_paper>(); });
  const auto second = co_await tess::when_any(
      tess::sleep(1h), tess::epoch([&] { clerks[{3}].send<&Clerk::pass>(0); }));
  found.after_first = static_cast<int>(second.index());
  tess::Future<int> there;
  co_await tess::epoch([&] { there.callback()(5); });
  const auto at_once = co_await tess::when_any(there, tess::epoch([&] { found.ran = true; }));
  found.at_once = at_once.index();
  try {
    (void)co_await tess::when_all(tess::epoch([] { tess::fail(tess::ErrorCode::bad_value, "no"); }),
                                  tess::sleep(1us));
  } catch (const tess::Error& error) {
    found.error = error.what();
  }
  tess::Future<int> own;
  clerks[{2}].send<&Clerk::read_own>(own.callback());
  found.own = co_await own;
  tess::Future<int> kept;
  clerks[{1}].send<&Clerk::read_in_vain>(kept.callback());
  found.kept = co_await kept;
  std::vector<tess::Task> tasks;
  for (const bool fails : {false, true, true, false})
    tasks.push_back(count_later(found.n_done, fails));
  try {
    co_await tess::when_all(std::move(tasks));
  } catch (const tess::Error& error) {
    found.error += error.what();
  }
}

void check_joined(const Joined& found) {
  tess::test::expect(found.of_both == 20, "filed ", found.of_both);
  tess::test::expect(found.first == 1, "first ", found.first);
  tess::test::expect(found.after_first == 1, "second ", found.after_first);
  tess::test::expect(found.at_once == 0 && !found.ran, "at once ", found.at_once);
  tess::test::expect(found.error == "no, nor this", found.error);
  tess::test::expect(found.kept == 25, "kept ", found.kept);
  tess::test::expect(found.n_done == 4, "tasks ", found.n_done);
  tess::test::expect(found.own == 11 || found.own == 22, "own ", found.own);
}

}  // namespace

TEST_CASE("epochs are awaited together, and the first of several", "[runtime][when]") {
  tess::test::for_seeds(0, 100, [](std::uint64_t seed) {
    Joined found;
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
    machine.run([&]() -> tess::Task { return join(found); }).require_success();
    check_joined(found);
  });
}

TEST_CASE("epochs are awaited together on the machine of threads", "[runtime][when][threads]") {
  Joined found;
  REQUIRE(tests::run_threads(2, [&]() -> tess::Task { return join(found); }).exit_code == 0);
  tess::test::expect(
      found.of_both == 20 && found.own != 0 && found.error == "no, nor this" && found.at_once == 0,
      "threads");
}
