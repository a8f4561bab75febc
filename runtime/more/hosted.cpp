#include "runtime/more/hosted.hpp"

#include "runtime/wire/machine/threads.hpp"

#include <exception>
#include <mutex>

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

}  // namespace

void run_hosted(std::int32_t n_pes, const std::function<Task()>& main) {
  constexpr std::int32_t most_pes = 4096;
  if (n_pes < 1 || n_pes > most_pes)
    fail(ErrorCode::bad_argument, "pes: ", n_pes, " is not a number of threads from 1 to ",
         most_pes);
  static std::mutex one_run;
  const std::lock_guard turn(one_run);
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
  const int code = run(setup, [&]() -> Task { return run_to_end(main, error, is_done); });
  if (error) std::rethrow_exception(error);
  if (code != 0 || !is_done)
    fail(ErrorCode::environment, "the run ended before its task, with exit code ", code, report);
}

}  // namespace tess
