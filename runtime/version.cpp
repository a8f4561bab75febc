#include "runtime/version.hpp"

#include "runtime/wire/machine/mpi.hpp"

namespace tess {
namespace detail {
// The one source that a commit changes defines them; cmake/commit.cmake writes it.
extern const char* const version_of_build;
extern const char* const preset_of_build;
extern const char* const commit_of_build;
}  // namespace detail

namespace {
#ifdef __clang__
constexpr const char* compiler = "clang++ " __clang_version__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif
}  // namespace

const Build& build() {
  static const Build build{detail::version_of_build, detail::commit_of_build,
                           detail::preset_of_build, compiler, detail::mpi_version()};
  return build;
}

std::string version_text(const std::string& program) {
  const Build& b = build();
  return program + " (Tessera) " + b.version + ", commit " + b.commit + ", preset " + b.preset +
         ", " + b.compiler + ", " + b.mpi + '\n';
}

}  // namespace tess
