// Checkpoints: the state of a run in files, and a later run that continues from them, on any number
// of PEs and processes and on any kind of machine.
//
// Sample: tests/samples/checkpoint.cpp
//
//     State state;
//     if (restarts) {
//       state = co_await tess::restart<State>(folder);
//     } else {
//       state.cells = tess::create<Cell>(tess::range(8));
//     }
//     while (state.step < last) {
//       const int of_all = co_await state.cells.reduce<&Cell::step>();
//       state.total += of_all;
//       if (++state.step % 10 == 0) co_await tess::checkpoint(folder, state);
//     }
//
// A checkpoint has the elements of all arrays, groups, single chares and sections, and the state
// object of the main coroutine, with the proxies in it. Elements need a default constructor and
// serialize(), as for migration. After a restart they are on the homes of their indices, single
// chares where they were. On another number of PEs these are spread as a new run spreads them.
//
// A checkpoint is made at a quiet point: checkpoint() waits until no message is under way, and
// throws an Error that names what waits if something does: a coroutine of a chare, an unfinished
// reduction, a message to an element that does not exist, a timer.
//
// CheckpointOptions::buddy_copies: the folder is in the memory of each host (/dev/shm), and a
// second host has a copy of each file. A restart finds what is left when a host was lost.
//
// Futures, timers and balancers are not saved. A state with a future does not compile. A callback
// to a future may be left over in the state or in an element; after a restart a call of it ends the
// run with an error, so make the future again and send its new callback. Before restart() there is
// no future, no timer and no array yet, nor one that has ended. Call start_balancing() again; the
// loads of balanced elements are saved, and BalancerProxy::place_again() uses them. Process groups
// and read-only data cannot be saved; destroy() them before.
#pragma once

#include "runtime/checkpoint/restore.hpp"
#include "runtime/checkpoint/save.hpp"
#include "runtime/checkpoint_options.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/core/type_name.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tess {

/// Saves the run in `folder`, which all processes can reach, unless there are buddy copies. Called
/// in the main coroutine, outside of epochs. Throws Error if the run is not quiet, if the files
/// cannot be written, or if the folder has checkpoints of another run: of one that is neither this
/// run nor one that this run, or one before it, went on with by restart() (if the folder has one of
/// these, those of another restart from it count as its own); then the run can go on. The state is
/// packed once all messages are done, as the elements are, and lives until the task ends. `note`: a
/// text for people in the manifest, such as the program's options and the step.
template <class State>
[[nodiscard]] Task checkpoint(const std::string& folder, const State& state,
                              const CheckpointOptions& options = {}, std::string note = {}) {
  return detail::write_checkpoint(
      folder, std::string(name_of_type<State>), [&state] { return to_bytes(state); }, options,
      std::move(note));
}
/// A temporary changes no more: it is packed at once.
template <class State>
[[nodiscard]] Task checkpoint(const std::string& folder, const State&& state,
                              const CheckpointOptions& options = {}, std::string note = {}) {
  return detail::write_checkpoint(
      folder, std::string(name_of_type<State>), [bytes = to_bytes(state)] { return bytes; },
      options, std::move(note));
}

/// The latest finished checkpoint in a folder as this process sees it, as its path; empty if there
/// is none. A program that does not restart from there gives checkpoint() another folder.
[[nodiscard]] inline std::string latest_checkpoint(const std::string& folder) {
  return detail::latest_checkpoint(folder);
}

/// Restores the latest good checkpoint of the folder. A damaged one is reported on standard error,
/// and the one before is used; likewise a damaged file whose buddy copy is used. Called before
/// anything else in the main coroutine. Throws Error if there is none that this program can restore
/// on this many PEs. A group that was saved on another number of PEs needs a member function
/// absorb(Member&&): member p of the checkpoint goes to PE p modulo the number of PEs, where the
/// first to arrive becomes the member and absorbs the others, in any order; a PE without one gets a
/// member from the default constructor.
template <class State>
TaskOf<State> restart(std::string folder) {
  const std::vector<std::byte> bytes =
      co_await detail::read_checkpoint(std::move(folder), std::string(name_of_type<State>));
  try {
    co_return from_bytes<State>(bytes);
  } catch (const Error& error) {
    detail::refuse_state(name_of_type<State>, error);
  }
}

}  // namespace tess
