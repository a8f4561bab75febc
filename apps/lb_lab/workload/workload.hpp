// A workload: work that moves through a domain of cells, and an answer that does not depend on
// where, when and in how many elements it is computed. One function gives the cost of a cell,
// another one its next state; states do not depend on costs. A new workload of cells is a line in
// workloads.cpp. A workload with other chares is a kind of its own (kind.hpp); the domain is then
// the space that its chares share.
#pragma once

#include "apps/lb_lab/workload/domain.hpp"
#include "runtime/core/hash.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lb_lab {

/// A workload with all its numbers: travels in messages.
struct Problem {
  std::uint32_t workload = 0;  ///< position in workloads()
  Domain domain;
  std::int32_t n_pes = 1;
  std::int32_t n_iterations = 1;
  std::uint64_t seed = 1;
  double cell_seconds = 0;          ///< work of a cell of relative work 1 on a PE of speed 1
  std::uint64_t cell_bytes = 0;     ///< cargo that migrates with a cell
  std::uint64_t message_bytes = 0;  ///< ballast of a message to a neighbour
};

/// The states of a cell and of its neighbours after the last iteration; 0 beyond the border.
struct Stencil {
  std::uint64_t self = 0, west = 0, east = 0, south = 0, north = 0;
};

enum class Shape : std::uint8_t { line, plane };
enum class Traffic : std::uint8_t { silent, neighbours };

struct Kind;
extern const Kind cells_kind, collision_kind, particles_kind;

struct Workload {
  std::string name;
  std::string_view what;
  // Of workloads of cells only:
  /// Relative work of a cell in an iteration, at least 0, about 1 on average.
  double (*work)(const Problem&, Cell, std::int32_t iteration) = nullptr;
  std::uint64_t (*first)(const Problem&, Cell) = nullptr;
  std::uint64_t (*next)(const Problem&, Cell, std::int32_t iteration, const Stencil&) = nullptr;
  Shape shape = Shape::line;
  Traffic traffic = Traffic::silent;  ///< silent: a cell does not depend on its neighbours
  const Kind* kind = &cells_kind;
};

/// A random number of [0, 1) that depends on the seed only.
[[nodiscard]] inline double drawn(std::uint64_t seed) {
  return tess::unit(tess::mix(seed));
}

[[nodiscard]] const std::vector<Workload>& workloads();
[[nodiscard]] inline const Workload& workload_of(const Problem& problem) {
  return workloads()[problem.workload];
}

/// Position of a name in workloads(). Throws tess::Error that lists the names for any other.
[[nodiscard]] std::uint32_t find_workload(std::string_view name);

/// Seconds at speed 1 of a block in an iteration.
[[nodiscard]] double block_seconds(const Problem& problem, const Block& block,
                                   std::int32_t iteration);

/// A cell's part of the answer, from its state after the last iteration and the hash of its cargo.
/// The answer is the sum over all cells.
[[nodiscard]] std::uint64_t answer_of(const Problem& problem, Cell cell, std::uint64_t state,
                                      std::uint64_t carried);

/// The cargo that migrates with a cell: `cell_bytes` / 8 words that depend on its number.
[[nodiscard]] std::vector<std::uint64_t> cargo_of(const Problem& problem, Cell cell);

/// The answer, computed without chares and messages.
[[nodiscard]] std::uint64_t serial_answer(const Problem& problem);

/// Seconds at speed 1 of all iterations; nominal where the work is real.
[[nodiscard]] double total_seconds(const Problem& problem);

}  // namespace lb_lab
