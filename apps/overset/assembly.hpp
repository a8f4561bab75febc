// One overset assembly: a background mesh, and meshes around bodies that overlap it. The wall of
// each body cuts holes into the other meshes; the fringe of each mesh takes values of the others.
#pragma once

#include "m2m/field.hpp"
#include "m2m/overset.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace overset {

struct Problem {
  std::vector<tess::m2m::TetMesh> meshes;  ///< background, then one around each body
  // Per mesh around a body:
  std::vector<tess::m2m::Wall> walls;
  std::vector<std::vector<std::uint8_t>> on_outer;  ///< per point
  std::string wall_remarks{};                       ///< of a surface file
  std::string field = "gaussian";                   ///< tess::m2m::make_formula()
  tess::m2m::BlankingOptions options;
  std::int32_t n_parts = 2;  ///< per mesh
};

struct Request {
  std::string background = "kuhn:24";
  std::vector<std::string> overset{"ball:12"};
  std::string wall;                     ///< a surface file or the name of a side set; empty: found
  std::vector<std::string> symmetry{};  ///< "z=0" or "0.6:0.8:0=2": sides of the background
};

/// The meshes and the walls by name: a file or kuhn:N, the latter or ball:N and so on (body.hpp).
/// Throws Error if one cannot be read, if there is no wall, if a wall stands on a side of the
/// background that is no plane of symmetry, or if nothing meets a plane of symmetry.
[[nodiscard]] Problem read_problem(const Request& request);

/// What is known of one mesh afterwards. Lists: per point of the mesh.
struct Assembled {
  tess::m2m::BlankingReport report;
  std::vector<std::int32_t> iblank;
  std::vector<double> quality, values;
  double linf = 0, rms = 0;  ///< |value - field| at fringe points with a donor
};
struct Assembly {
  std::vector<Assembled> meshes;
  double cut = 0, search = 0, exchange = 0;  ///< wall-clock seconds
  std::uint64_t hash = 0;                    ///< of all lists
};

/// A coroutine of the main program.
tess::TaskOf<Assembly> assemble(const Problem& problem);

}  // namespace overset
