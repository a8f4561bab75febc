// What the environment says of mpirun and srun, in builds with and without MPI.
#include "runtime/wire/machine/mpi.hpp"

#include <cstdlib>
#include <initializer_list>
#include <string_view>

namespace tess::detail {
namespace {

/// The first of these variables of the environment that is set; null if none is.
const char* first_of(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
    if (const char* value = std::getenv(name); value != nullptr) return value;
  }
  return nullptr;
}

/// The rank that a launcher gave this process; null if it was started alone.
const char* rank_given() {
  return first_of({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"});
}

}  // namespace

bool under_mpirun() {
  return rank_given() != nullptr;
}

int processes_of_job() {
  if (!under_mpirun()) return 1;
  const char* size = first_of({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"});
  return size == nullptr ? 0 : std::atoi(size);
}

bool speaks_for_job() {
  const char* rank = rank_given();
  return rank == nullptr || std::string_view(rank) == "0";
}

}  // namespace tess::detail
