#include "runtime/wire/machine/mpi_session.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace tess::detail {

void must(int result, const char* call) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> reason{};
  int length = 0;
  int rank = -1;
  MPI_Error_string(result, reason.data(), &length);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::fprintf(stderr, "tessera: %s failed on process %d: %s\n", call, rank, reason.data());
  std::fflush(nullptr);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::_Exit(1);
}

namespace {

/// Ends the process with this exit code unless it is destroyed in time.
class EndAfter {
 public:
  EndAfter(std::chrono::milliseconds time, int exit_code)
      : thread_([this, time, exit_code](const std::stop_token& stop) {
          std::unique_lock lock(mutex_);
          if (changed_.wait_for(lock, stop, time, [] { return false; }) || stop.stop_requested())
            return;
          std::fflush(nullptr);
          std::_Exit(exit_code);
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::jthread thread_;
};

constexpr std::chrono::milliseconds finalize_time{200};

/// Holds what sessions that have ended left. One thread makes and ends sessions.
std::vector<Session::Channel> idle_channels;

/// MPI calls it when it ends.
int free_channels(MPI_Comm /*self*/, int /*key*/, void* /*value*/, void* /*extra*/) {
  for (Session::Channel& one : idle_channels) {
    MPI_Comm_free(&one.comm);
    MPI_Comm_free(&one.chunk_comm);
  }
  idle_channels.clear();
  return MPI_SUCCESS;
}

/// The idle channel of the lowest number, which is the same on all processes; otherwise a new one.
Session::Channel take_channel() {
  static int n_made = 0;
  if (!idle_channels.empty()) {
    const auto lowest = std::ranges::min_element(idle_channels, {}, &Session::Channel::number);
    const Session::Channel taken = *lowest;
    idle_channels.erase(lowest);
    return taken;
  }
  if (n_made == 0) {
    int key = MPI_KEYVAL_INVALID;
    must(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, &free_channels, &key, nullptr),
         "MPI_Comm_create_keyval");
    must(MPI_Comm_set_attr(MPI_COMM_SELF, key, nullptr), "MPI_Comm_set_attr");
  }
  Session::Channel made{n_made++};
  must(MPI_Comm_dup(MPI_COMM_WORLD, &made.comm), "MPI_Comm_dup");
  must(MPI_Comm_set_errhandler(made.comm, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  must(MPI_Comm_dup(made.comm, &made.chunk_comm), "MPI_Comm_dup");
  return made;
}

const char* name_of_level(int level) {
  return level == MPI_THREAD_SINGLE     ? "MPI_THREAD_SINGLE"
         : level == MPI_THREAD_FUNNELED ? "MPI_THREAD_FUNNELED"
                                        : "below MPI_THREAD_SERIALIZED";
}

}  // namespace

bool program_owns_mpi() {
  int initialised = 0;
  int over = 0;
  MPI_Initialized(&initialised);
  MPI_Finalized(&over);
  return initialised != 0 && over == 0;
}

Session::Session(int& argc, char**& argv) {
  int over = 0;
  MPI_Finalized(&over);
  if (over != 0)
    fail(ErrorCode::environment,
         "MPI has ended and cannot be started again: initialise it by MPI_Init_thread before "
         "the first run of several, and finalise it after the last (runtime/CLUSTER.md)");
  int initialised = 0;
  MPI_Initialized(&initialised);
  ours_ = initialised == 0;
  int provided = MPI_THREAD_SINGLE;
  if (ours_)
    must(MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
  else
    must(MPI_Query_thread(&provided), "MPI_Query_thread");
  if (provided < MPI_THREAD_SERIALIZED)
    fail(ErrorCode::environment,
         ours_ ? "MPI gives thread level " : "this program initialised MPI with thread level ",
         name_of_level(provided), ", but PEs call MPI from several threads: ",
         ours_ ? "use an MPI built with threads"
               : "initialise it by MPI_Init_thread with MPI_THREAD_SERIALIZED or "
                 "MPI_THREAD_MULTIPLE");
  channel_ = take_channel();
  set_check_abort([] { MPI_Abort(MPI_COMM_WORLD, 1); });
}

Session::~Session() {
  set_check_abort(nullptr);
  idle_channels.push_back(channel_);
  if (!ours_) return;
  std::optional<EndAfter> limit;
  if (hurried_code_ >= 0) limit.emplace(finalize_time, hurried_code_);
  MPI_Finalize();
}

std::int32_t Session::n_processes() const {
  int n = 0;
  must(MPI_Comm_size(comm(), &n), "MPI_Comm_size");
  return n;
}

std::int32_t Session::process() const {
  int me = 0;
  must(MPI_Comm_rank(comm(), &me), "MPI_Comm_rank");
  return me;
}

bool Session::agree(std::uint64_t mine) const {
  const std::array<std::uint64_t, 2> both{mine, ~mine};
  std::array<std::uint64_t, 2> least{};
  must(MPI_Allreduce(both.data(), least.data(), 2, MPI_UINT64_T, MPI_MIN, comm()), "MPI_Allreduce");
  return least[0] == ~least[1];  // the smallest is the greatest, on every process alike
}

std::int32_t Session::least(std::int32_t mine) const {
  std::int32_t least = mine;
  must(MPI_Allreduce(&mine, &least, 1, MPI_INT32_T, MPI_MIN, comm()), "MPI_Allreduce");
  return least;
}

Session::Sharing Session::sharing(const std::string& cpuset) {
  if (channel_.sharing) return *channel_.sharing;
  MPI_Comm host = MPI_COMM_NULL;
  must(MPI_Comm_split_type(comm(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host),
       "MPI_Comm_split_type");
  int n = 0;
  int me = 0;
  must(MPI_Comm_size(host, &n), "MPI_Comm_size");
  must(MPI_Comm_rank(host, &me), "MPI_Comm_rank");
  const std::uint64_t mine = std::hash<std::string>()(cpuset);
  std::vector<std::uint64_t> all(static_cast<std::size_t>(n));
  must(MPI_Allgather(&mine, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, host), "MPI_Allgather");
  must(MPI_Comm_free(&host), "MPI_Comm_free");
  channel_.sharing = {static_cast<std::int32_t>(std::count(all.begin(), all.end(), mine)),
                      static_cast<std::int32_t>(std::count(all.begin(), all.begin() + me, mine))};
  return *channel_.sharing;
}

}  // namespace tess::detail
