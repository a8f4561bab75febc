#include "runtime/balance/strategy.hpp"
#include "runtime/core/error.hpp"

#include <dlfcn.h>

namespace tess::balance {

void load_strategy_library(const std::string& path) {
  const auto refuse = [&path](const auto&... why) {
    fail(ErrorCode::bad_argument, "--strategy-library: ", path, ": ", why...);
  };
  // A name without a folder would be searched for where the system has its libraries.
  const bool has_folder = path.find('/') != std::string::npos;
  void* const library = dlopen(((has_folder ? "" : "./") + path).c_str(), RTLD_NOW);
  if (library == nullptr)
    refuse("cannot be loaded (", dlerror(), "); give a shared library, as g++ -shared -fPIC makes");
  auto* const register_all =
      reinterpret_cast<void (*)()>(dlsym(library, "tess_register_strategies"));
  constexpr const char* remedy = "; call tess::balance::register_strategy(\"mine\", f) in it";
  if (register_all == nullptr)
    refuse("does not export extern \"C\" void tess_register_strategies()", remedy);
  const std::size_t n_before = strategy_names().size();
  try {
    register_all();
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  if (strategy_names().size() == n_before) refuse("registers no strategy", remedy);
}

}  // namespace tess::balance
