// What the environment says of mpirun and srun, in builds with and without MPI.
#include "runtime/machine/mpi.hpp"

#include <cstdlib>
#include <string_view>

namespace tess::detail {
namespace {

/// The rank that a launcher gave this process; null if it was started alone.
const char* rank_given() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): asked before there are threads
    if (const char* rank = std::getenv(name); rank != nullptr) return rank;
  }
  return nullptr;
}

}  // namespace

bool under_mpirun() {
  return rank_given() != nullptr;
}

bool speaks_for_job() {
  const char* rank = rank_given();
  return rank == nullptr || std::string_view(rank) == "0";
}

}  // namespace tess::detail
