#include "apps/m2m_scaling/own_process.hpp"

#include "runtime/core/error.hpp"
#include "runtime/run.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <type_traits>
#include <unistd.h>

namespace m2m_scaling {

static_assert(std::is_trivially_copyable_v<Row>);

namespace {

[[noreturn]] void refuse(const char* call) {
  tess::fail(tess::ErrorCode::environment, call, ": ", std::generic_category().message(errno),
             "; each machine is measured in a process of its own");
}

}  // namespace

int in_own_process(const char* program, const std::function<int(Row&)>& run, Row& row) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) refuse("pipe");
  std::fflush(nullptr);  // otherwise the child prints it, too
  const pid_t child = ::fork();
  if (child < 0) refuse("fork");
  if (child == 0) {
    ::close(ends[0]);
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with the parent
    const int code = tess::guarded(program, [&] { return run(row); });
    const bool is_written = code == 0 && ::write(ends[1], &row, sizeof row) == ssize_t{sizeof row};
    std::fflush(nullptr);
    std::_Exit(code != 0 || is_written ? code : 1);
  }
  ::close(ends[1]);
  const bool is_read = ::read(ends[0], &row, sizeof row) == ssize_t{sizeof row};
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) return WEXITSTATUS(status);
  if (WIFSIGNALED(status))
    tess::fail(tess::ErrorCode::environment, "the process that measured was ended by signal ",
               WTERMSIG(status), "; if it was 9, the memory may not have sufficed");
  if (!is_read)
    tess::fail(tess::ErrorCode::environment,
               "the process that measured ended without a result; see what it printed");
  return 0;
}

}  // namespace m2m_scaling
