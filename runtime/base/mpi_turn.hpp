// The threads of a process take turns in MPI, which is initialised for one at a time
// (MPI_THREAD_SERIALIZED).
#pragma once

#include "runtime/base/try_lock.hpp"

#include <thread>

namespace tess::detail {

/// The lock of all calls of MPI while PEs run. A PE that does not get it does without: the one that
/// holds it makes messages progress.
inline TryLock& mpi_lock() {
  static TryLock lock;
  return lock;
}

/// For a library that calls MPI itself: its calls are the only ones in this process while a turn
/// lives. Messages to and from other processes wait.
class MpiTurn {
 public:
  MpiTurn() {
    while (!mpi_lock().try_lock()) std::this_thread::yield();  // held for microseconds
  }
  ~MpiTurn() { mpi_lock().unlock(); }
  MpiTurn(const MpiTurn&) = delete;
  MpiTurn& operator=(const MpiTurn&) = delete;
};

}  // namespace tess::detail
