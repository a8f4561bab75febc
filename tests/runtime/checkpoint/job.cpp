// test_checkpoint_job FOLDER LAST [buddy | buddy-restart [FROM]]: runs the world of world.hpp to step
// LAST, with a checkpoint after each second step, from the last checkpoint in FOLDER if there is
// one. Prints the step that it began at and its log. With "buddy" FOLDER is local to each rank, and
// the run restarts only if told to, from FROM if that is given.
#include "runtime/checkpoint.hpp"
#include "tests/runtime/checkpoint/world.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/core.h>

namespace {

tess::Task run_to(std::string folder, std::int32_t last, std::string from, bool buddy) {
  world::State state;
  if (!from.empty()) {
    state = co_await tess::restart<world::State>(from);
  } else {
    co_await world::make(state);
  }
  const std::int32_t first = state.step;
  while (state.step < last) {
    co_await world::advance(state);
    if (state.step % 2 == 0) co_await tess::checkpoint(folder, state, {.buddy_copies = buddy});
  }
  tess::print(fmt::format("from {} log {:016x}\n", first, state.log));
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    if (argc < 3)
      tess::fail(tess::ErrorCode::bad_argument,
                 "usage: test_checkpoint_job FOLDER LAST [buddy | buddy-restart [FROM]]");
    const std::string how = argc > 3 ? argv[3] : "";
    const bool restarts = how.empty() ? std::filesystem::exists(argv[1]) : how == "buddy-restart";
    const std::string from = !restarts ? "" : argc > 4 ? argv[4] : argv[1];
    return tess::run(setup,
                     [&] { return run_to(argv[1], std::atoi(argv[2]), from, !how.empty()); });
  });
}
