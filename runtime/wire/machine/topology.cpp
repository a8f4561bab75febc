#include "runtime/wire/machine/topology.hpp"

#include "runtime/core/error.hpp"

#include <hwloc.h>

#include <vector>

namespace tess::detail {

struct Topology::Handle {
  hwloc_topology_t topology = nullptr;
  hwloc_cpuset_t allowed = hwloc_bitmap_alloc();
  std::vector<hwloc_cpuset_t> cores;  // each within `allowed`

  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    for (hwloc_cpuset_t core : cores) hwloc_bitmap_free(core);
    hwloc_bitmap_free(allowed);
    if (topology != nullptr) hwloc_topology_destroy(topology);
  }
};

Topology::Topology() : handle_(std::make_unique<Handle>()) {
  Handle& h = *handle_;
  // Only cores: caches, memory and devices would cost milliseconds at every start.
  if (hwloc_topology_init(&h.topology) != 0 ||
      hwloc_topology_set_all_types_filter(h.topology, HWLOC_TYPE_FILTER_KEEP_NONE) != 0 ||
      hwloc_topology_set_type_filter(h.topology, HWLOC_OBJ_CORE, HWLOC_TYPE_FILTER_KEEP_ALL) != 0 ||
      hwloc_topology_load(h.topology) != 0)
    fail(ErrorCode::environment, "hwloc cannot read the topology of this machine");

  if (hwloc_get_cpubind(h.topology, h.allowed, HWLOC_CPUBIND_THREAD) != 0)
    hwloc_bitmap_copy(h.allowed, hwloc_topology_get_allowed_cpuset(h.topology));

  const auto add_all = [&h](hwloc_obj_type_t type) {
    for (hwloc_obj_t obj = nullptr;
         (obj = hwloc_get_next_obj_by_type(h.topology, type, obj)) != nullptr;) {
      hwloc_cpuset_t part = hwloc_bitmap_alloc();
      hwloc_bitmap_and(part, obj->cpuset, h.allowed);
      if (hwloc_bitmap_iszero(part) != 0)
        hwloc_bitmap_free(part);
      else
        h.cores.push_back(part);
    }
  };
  add_all(HWLOC_OBJ_CORE);
  if (h.cores.empty()) add_all(HWLOC_OBJ_PU);  // some virtual machines report no cores
  if (h.cores.empty()) fail(ErrorCode::environment, "hwloc finds no core in the set ", cpuset());
  n_cores_ = static_cast<std::int32_t>(h.cores.size());
}

Topology::~Topology() = default;

bool Topology::pin(std::int32_t core) const {
  return hwloc_set_cpubind(handle_->topology, handle_->cores.at(static_cast<std::size_t>(core)),
                           HWLOC_CPUBIND_THREAD) == 0;
}

void Topology::unpin() const {
  hwloc_set_cpubind(handle_->topology, handle_->allowed, HWLOC_CPUBIND_THREAD);
}

std::string Topology::cpuset() const {
  const int length = hwloc_bitmap_list_snprintf(nullptr, 0, handle_->allowed);
  std::string out(static_cast<std::size_t>(length) + 1, '\0');
  hwloc_bitmap_list_snprintf(out.data(), out.size(), handle_->allowed);
  out.resize(static_cast<std::size_t>(length));
  return out;
}

std::string Placement::describe(const Topology& topology) const {
  return text(" on ", topology.n_cores(), topology.n_cores() == 1 ? " core (" : " cores (",
              topology.cpuset(),
              pinned           ? "), pinned"
              : oversubscribed ? "), more PEs than cores: not pinned"
                               : "), not pinned");
}

}  // namespace tess::detail
