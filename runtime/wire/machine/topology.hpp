// The cores that this process may use, and the pinning of threads to them. It is the only user of
// hwloc. The usable cores are the affinity of the thread that constructs the Topology: those that
// mpirun, a batch system or taskset gave to the process. No core outside this set is ever used.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace tess::detail {

class Topology {
 public:
  Topology();
  ~Topology();
  Topology(const Topology&) = delete;
  Topology& operator=(const Topology&) = delete;

  /// The number of cores (not hyperthreads) with at least one thread in the process's set; at least
  /// 1.
  [[nodiscard]] std::int32_t n_cores() const { return n_cores_; }

  /// Pins the calling thread to the `core`-th core of the set. Returns false if the system refuses.
  bool pin(std::int32_t core) const;

  /// Lets the calling thread run on the whole set again.
  void unpin() const;

  /// The set as text. Two processes of a host have equal texts if and only if they share the same
  /// cores.
  [[nodiscard]] std::string cpuset() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::int32_t n_cores_ = 1;
};

/// Where the PEs of a process run.
struct Placement {
  bool pinned = false;
  std::int32_t first_core = 0;  // index in the process's set of the first PE's core
  bool oversubscribed = false;  // more PEs than cores, over all processes that share the cores

  /// " on 2 cores (0-1), pinned".
  [[nodiscard]] std::string describe(const Topology& topology) const;
};

}  // namespace tess::detail
