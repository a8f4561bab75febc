// What the environment says of mpirun and srun, in builds with and without MPI.
#include "runtime/machine/mpi.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace tess::detail {

bool under_mpirun() {
  return std::ranges::any_of(std::array{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"},
                             [](const char* name) {
                               // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
                               return std::getenv(name) != nullptr;
                             });
}

bool speaks_for_job() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
    if (const char* rank = std::getenv(name); rank != nullptr) return std::string_view(rank) == "0";
  }
  return true;
}

}  // namespace tess::detail
