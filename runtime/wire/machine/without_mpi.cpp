// In place of the mpi_* files where Tessera is built with TESS_MPI=OFF.
#include "runtime/core/error.hpp"
#include "runtime/wire/machine/mpi.hpp"

namespace tess::detail {

std::string mpi_version() {
  return "no MPI";
}

bool program_owns_mpi() {
  return false;
}

std::unique_ptr<Machine> make_mpi_machine(int& /*argc*/, char**& /*argv*/, MpiOptions /*options*/) {
  fail(
      ErrorCode::environment,
      "mpirun started this program, but its Tessera is built without MPI: start it alone, or build "
      "Tessera with TESS_MPI=ON");
}

}  // namespace tess::detail
