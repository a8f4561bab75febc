// Futures and checkpoints: a callback that was saved finds no future of the run after the restart.
#include "runtime/checkpoint.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/support/scratch.hpp"

#include <chrono>
#include <cstdio>
#include <sys/wait.h>
#include <unistd.h>

namespace {

/// It keeps the target of its results.
class Keeper : public tess::Chare<Keeper> {
 public:
  void keep(const tess::Callback<int>& target) { target_ = target; }
  void report() { target_(index().x); }
  void report_to(const tess::Callback<int>& target) { contribute(tess::sum, index().x, target); }
  void serialize(auto& ar) { ar(target_); }

 private:
  tess::Callback<int> target_;
};

struct Kept {
  tess::ArrayProxy<Keeper> keepers;
  tess::Callback<int> target;
};

/// Elements keep a callback to a future of the main coroutine, and so does its state.
tess::Task keep(std::string folder, int n_futures) {
  Kept state;
  state.keepers = tess::create<Keeper>(tess::range(5));
  const std::vector<tess::Future<int>> more(static_cast<std::size_t>(n_futures));
  for (const tess::Future<int>& one : more) (void)one.callback();
  const tess::Future<int> sum;
  state.target = sum.callback();
  state.keepers.broadcast<&Keeper::keep>(sum.callback());
  co_await tess::checkpoint(folder, state);
  tess::exit(0);
}

/// The run has many futures, and an old callback is called: by an element, or by this coroutine.
tess::Task call_old(std::string folder, bool by_main) {
  const auto state = co_await tess::restart<Kept>(folder);
  std::vector<tess::Future<int>> some(40);
  for (const tess::Future<int>& one : some) (void)one.callback();
  if (by_main)
    state.target(3);
  else
    state.keepers[{2}].send<&Keeper::report>();
  co_await tess::sleep(std::chrono::milliseconds(1));
  for (tess::Future<int>& one : some)
    if (one.await_ready()) std::fputs("a future of the new run was given a result\n", stderr);
}

tess::Task save_again(std::string folder) {
  const auto state = co_await tess::restart<Kept>(folder);
  tess::Future<int> total;
  state.keepers.broadcast<&Keeper::report_to>(total.callback());
  const int n = co_await total;
  CHECK(n == 10);
  co_await tess::checkpoint(folder, state);
  tess::exit(0);
}

/// A failed check ends the process, so the program runs in a child. Returns what that writes to
/// standard error, and how it ends.
template <class Program>
std::string errors_in_child(const std::string& file, int& status, const Program& program) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(file.c_str(), "w", stderr) == nullptr) ::_exit(77);
    ::_exit(program());
  }
  REQUIRE(child > 0);
  REQUIRE(::waitpid(child, &status, 0) == child);
  return tess::test::slurp(file);
}

}  // namespace

TEST_CASE("a callback that was saved is an error when it is called after a restart",
          "[runtime][checkpoint]") {
  constexpr const char* wanted = "a callback to a future of the run before the restart was called";
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    tess::test::completes(3, seed, [&] { return keep(folder, static_cast<int>(seed % 7)); });
    // After one restart, and after one more.
    for (int n = 0; n < 2; ++n) {
      int status = 0;
      const auto n_pes = static_cast<int>(1 + seed % 5);
      const std::string errors = errors_in_child(scratch.path("errors"), status, [&] {
        auto next = seed % 2 == 0 ? tess::Setup{tess::make_threads_machine(2), {}}
                                  : tess::test::adversarial(n_pes, seed);
        return tess::run(next, [&] { return call_old(folder, n == 0); });
      });
      INFO(errors);
      CHECK(status != 0);
      CHECK(errors.find(wanted) != std::string::npos);
      CHECK(errors.find("was given") == std::string::npos);
      tess::test::completes(2, seed, [&] { return save_again(folder); });
    }
  }
}
