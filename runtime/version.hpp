// Which build a program is: for --version, and for each JSON that a program writes.
#pragma once

#include <string>

namespace tess {

struct Build {
  std::string version;   ///< "0.2.0"
  std::string commit;    ///< "4f1c2e0", with "-dirty" for one that was changed; or "unknown"
  std::string preset;    ///< the name of the folder of the build: "release"
  std::string compiler;  ///< "g++ 12.2.0"
  std::string mpi;       ///< "Open MPI 4.1.4", or "no MPI"
};

[[nodiscard]] const Build& build();

/// "PROGRAM (Tessera) 0.2.0, commit 4f1c2e0, preset release, g++ 12.2.0, Open MPI 4.1.4", a line.
[[nodiscard]] std::string version_text(const std::string& program);

}  // namespace tess
