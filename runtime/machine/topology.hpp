// The cores this process may use, and how a thread is tied to one of them. hwloc stands behind it
// and nowhere else. "May use" is the affinity of the thread that makes the Topology: what mpirun, a
// batch system or taskset gave to the process. Nothing outside that set is ever used.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace tess {

class Topology {
 public:
  Topology();
  ~Topology();
  Topology(const Topology&) = delete;
  Topology& operator=(const Topology&) = delete;

  /// Cores, not hyperthreads, with at least one thread in the process's set; at least 1.
  [[nodiscard]] std::int32_t n_cores() const { return n_cores_; }

  /// Ties the calling thread to the `core`-th core of the set. False if the system refuses.
  bool pin(std::int32_t core) const;

  /// Gives the calling thread the whole set again.
  void unpin() const;

  /// The set as text, equal for two processes of a host exactly if they share the same cores.
  [[nodiscard]] std::string cpuset() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::int32_t n_cores_ = 1;
};

/// Where the PEs of a process run.
struct Placement {
  bool pinned = false;
  std::int32_t first_core = 0;  // of the process's set, for the first PE
  bool oversubscribed = false;  // more PEs than cores, counting all processes that share them

  /// " on 2 cores (0-1), pinned".
  [[nodiscard]] std::string describe(const Topology& topology) const;
};

}  // namespace tess
