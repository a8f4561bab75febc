#include "runtime/version.hpp"

#include "runtime/command_line.hpp"
#include "tests/support/catch.hpp"

TEST_CASE("a build knows its version, commit, preset, compiler and MPI", "[runtime][version]") {
  const tess::Build& build = tess::build();
  CHECK(build.version.find_first_not_of("0123456789.") == std::string::npos);
  CHECK(std::count(build.version.begin(), build.version.end(), '.') == 2);
  CHECK((build.commit == "unknown" || build.commit.find_first_of("0123456789abcdef") == 0));
  CHECK_FALSE(build.preset.empty());
  CHECK((build.compiler.starts_with("g++ 1") || build.compiler.starts_with("clang++ 1")));
  CHECK((build.mpi == "no MPI" || build.mpi.find_first_of("0123456789") != std::string::npos));
  CHECK(build.mpi.find(',') == std::string::npos);
  CHECK(tess::version_text("heat") == "heat (Tessera) " + build.version + ", commit " +
                                          build.commit + ", preset " + build.preset + ", " +
                                          build.compiler + ", " + build.mpi + "\n");
}
