// What the environment says of mpirun and srun, in builds with and without MPI.
#include "runtime/machine/mpi.hpp"

#include <cstdlib>
#include <string_view>

namespace tess::detail {

bool under_mpirun() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr ||
         std::getenv("PMI_RANK") != nullptr;
}

bool speaks_for_job() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
    if (const char* rank = std::getenv(name); rank != nullptr) return std::string_view(rank) == "0";
  }
  return true;
}

}  // namespace tess::detail
