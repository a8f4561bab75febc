// The use of MPI apart from messages: initialisation and finalisation, failed calls, and the data
// that processes exchange before the first message. One thread calls it, before and after the run.
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

namespace tess::detail {

/// If a call of MPI failed, ends the job and names the call and the process: a process or memory is
/// lost.
void must(int result, const char* call);

/// Initialises and finalises MPI, unless the program has initialised it. Throws Error if MPI does
/// not support threads.
class Session {
 public:
  Session(int& argc, char**& argv);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();

  /// Two communicators of all processes of the job, for this session only. They are kept for a later
  /// session, since a job may have thousands of short runs and making them takes ten exchanges.
  [[nodiscard]] MPI_Comm comm() const { return channel_.comm; }
  [[nodiscard]] MPI_Comm chunk_comm() const { return channel_.chunk_comm; }
  [[nodiscard]] std::int32_t n_processes() const;
  [[nodiscard]] std::int32_t process() const;

  /// MPI_Finalize does not return while mpirun ends the job: then the process ends with this code.
  void hurry(int exit_code) { hurried_code_ = exit_code; }

  /// True on all processes if all passed the same number; otherwise false on all.
  [[nodiscard]] bool agree(std::uint64_t mine) const;
  /// The smallest number that any process passed.
  [[nodiscard]] std::int32_t least(std::int32_t mine) const;

  /// The processes of this host that share exactly this process's cores, and its rank among them.
  struct Sharing {
    std::int32_t n_processes = 1;
    std::int32_t place = 0;
  };
  /// `cpuset`: the cores of this process, as text.
  [[nodiscard]] Sharing sharing(const std::string& cpuset);

  /// What a session leaves to a later one. Both have drained their messages: no run leaves one.
  struct Channel {
    int number = 0;  ///< equal on all processes
    MPI_Comm comm = MPI_COMM_NULL, chunk_comm = MPI_COMM_NULL;
    std::optional<Sharing> sharing{};
  };

 private:
  Channel channel_;
  bool ours_ = false;
  std::atomic<int> hurried_code_{-1};  // -1: no hurry
};

}  // namespace tess::detail
