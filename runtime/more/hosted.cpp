#include "runtime/more/hosted.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <atomic>
#include <exception>
#include <future>
#include <mutex>
#include <unistd.h>

namespace tess {
namespace {

Task run_to_end(const std::function<Task()>& main, std::exception_ptr& error, bool& is_done) {
  try {
    co_await main();
  } catch (...) {
    error = std::current_exception();
  }
  is_done = true;
}

/// The process whose run is under way, or 0. A forked process inherits it without the thread of the
/// run, which a mutex would make it wait for.
std::atomic<pid_t> runs_in{0};

/// Waits until no run is under way in this process.
struct Turn {
  Turn() {
    const pid_t here = getpid();
    for (pid_t seen = 0; !runs_in.compare_exchange_strong(seen, here); seen = 0) {
      if (seen != here)
        fail(ErrorCode::environment, "process ", here, " was forked from process ", seen,
             " while a run was under way there, so it cannot run: start processes by "
             "multiprocessing's \"spawn\" or \"forkserver\", or fork when nothing runs");
      runs_in.wait(seen);
    }
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() {
    runs_in = 0;
    runs_in.notify_one();
  }
};

}  // namespace

void run_hosted(std::int32_t n_pes, const std::function<Task()>& main) {
  constexpr std::int32_t most_pes = 4096;
  if (n_pes < 1 || n_pes > most_pes)
    fail(ErrorCode::bad_argument, "pes: ", n_pes, " is not a number of threads from 1 to ",
         most_pes);
  // Here, since run() is on another thread; and before the turn, which a run would wait for for ever.
  TESS_CHECK(detail::current_pe_or_null() == nullptr, "run_hosted() is called inside a run");
  const Turn turn;
  Setup setup{make_threads_machine(n_pes, detail::Pinning::none), {}};
  setup.options.signals = false;
  std::mutex of_report;
  std::string report;
  setup.options.report = [&](const std::string& line) {
    const std::lock_guard lock(of_report);
    report += "; " + line;
  };
  std::exception_ptr error;
  bool is_done = false;
  const auto task = [&]() -> Task { return run_to_end(main, error, is_done); };
  // The stack of the host's thread may be too small for a PE.
  const int code = std::async(std::launch::async, [&] { return run(setup, task); }).get();
  if (error) std::rethrow_exception(error);
  if (code != 0 || !is_done)
    fail(ErrorCode::environment, "the run ended before its task, with exit code ", code, report);
}

}  // namespace tess
