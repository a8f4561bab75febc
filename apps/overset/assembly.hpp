// One overset assembly: a background mesh, and a mesh around a body that overlaps it. The wall of
// the body cuts a hole into the background; the fringe of each mesh takes values of the other.
#pragma once

#include "m2m/field.hpp"
#include "m2m/overset.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace overset {

struct Problem {
  std::array<tess::m2m::TetMesh, 2> meshes;  ///< background, overset
  tess::m2m::Wall wall;                      ///< of the body
  std::string wall_remarks{};                ///< of its file
  std::vector<std::uint8_t> on_outer;        ///< per point of the overset mesh
  std::string field = "gaussian";            ///< tess::m2m::make_formula()
  tess::m2m::BlankingOptions options;
  std::int32_t n_parts = 2;  ///< per mesh
};

struct Request {
  std::string background = "kuhn:24", overset = "ball:12";
  std::string wall;  ///< a surface file or the name of a side set; empty: found
};

/// The meshes and the wall by name: a file or kuhn:N, the latter or ball:N and so on (body.hpp).
/// Throws Error if one cannot be read, or if there is no wall.
[[nodiscard]] Problem read_problem(const Request& request);

/// What is known of one mesh afterwards. Lists: per point of the mesh.
struct Assembled {
  tess::m2m::BlankingReport report;
  std::vector<std::int32_t> iblank;
  std::vector<double> quality, values;
  double linf = 0, rms = 0;  ///< |value - field| at fringe points with a donor
};
struct Assembly {
  std::array<Assembled, 2> meshes;
  double cut = 0, search = 0, exchange = 0;  ///< wall-clock seconds
  std::uint64_t hash = 0;                    ///< of all lists
};

/// A coroutine of the main program.
tess::TaskOf<Assembly> assemble(const Problem& problem);

}  // namespace overset
