// MPI around the messages: from its first use to its last, what a failed call means, what processes
// find out about one another before the first message. Called by one thread, before and after the
// run.
#pragma once

#include "runtime/core/error.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>

namespace tess {

/// Ends the job, naming the call and the process, if a call of MPI failed: a process is lost, or
/// memory.
void must(int result, const char* call);

/// MPI from first use to last; leaves it alone if the program had initialised it. Throws Error if
/// MPI knows no threads.
class Session {
 public:
  Session(int& argc, char**& argv);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();

  /// Of all processes of the job, and of this machine alone.
  [[nodiscard]] MPI_Comm comm() const { return comm_; }
  [[nodiscard]] std::int32_t n_processes() const;
  [[nodiscard]] std::int32_t process() const;

  /// True, on all processes alike, if all gave the same number.
  [[nodiscard]] bool agree(std::uint64_t mine) const;
  /// The least of what the processes give.
  [[nodiscard]] std::int32_t least(std::int32_t mine) const;

  /// The processes of this host that share exactly our cores, and our place among them.
  struct Sharing {
    std::int32_t n_processes = 1;
    std::int32_t place = 0;
  };
  /// `cpuset`: the cores of this process, as text.
  [[nodiscard]] Sharing sharing(const std::string& cpuset) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  bool ours_ = false;
};

}  // namespace tess
