#include "apps/m2m_transfer/problem.hpp"

#include "m2m/read_mesh.hpp"
#include "m2m/transfer.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace m2m_transfer {
namespace {

/// The edge of a cube with the volume of six average tetrahedra: 1/N for kuhn:N.
double typical_edge(const TetMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) volume += std::abs(signed_volume(mesh, t));
  return std::cbrt(6 * volume / static_cast<double>(mesh.n_tets()));
}

/// Refuses voxels so small that a cell index of either mesh exceeds 32 bits.
void check_voxel(double voxel, const Problem& problem) {
  double farthest = 0;
  for (const Aabb& box : {problem.source_census.bounds, problem.target_census.bounds}) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      farthest = std::max({farthest, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
  }
  const double least = farthest * 0x1p-30;
  if (voxel < least)
    fail(ErrorCode::bad_argument, "--voxel ", voxel, " is too small for coordinates up to ",
         farthest, "; it must be at least ", least);
}

}  // namespace

Problem load(const Request& request, const Machine& machine) {
  Problem problem;
  problem.policy = parse_policy(request.policy);
  problem.partition = parse_partition_method(request.partition);
  problem.kind = parse_transfer_kind(request.kind);
  problem.repeat = request.repeat;
  problem.steps = request.steps;
  problem.source = read_mesh(request.source);
  problem.target = read_mesh(request.target);
  problem.source_census = validate(problem.source);
  problem.target_census = validate(problem.target);
  const Aabb& domain = problem.source_census.bounds;
  for (const std::string& name : request.fields) {
    const Formula formula = make_formula(name, domain);
    problem.source_fields.push_back(sample(problem.source, name, formula));
    problem.truth.push_back(sample(problem.target, name, formula));
    problem.target_fields.push_back({name, 1, std::vector<double>(problem.target.n_points(), 0.0)});
  }
  if (request.voxel > 0) check_voxel(request.voxel, problem);
  problem.voxel = {request.voxel, request.voxel, request.voxel};

  TransferReport& report = problem.report;
  report.source = request.source;
  report.target = request.target;
  report.source_skipped = skipped_text(problem.source);
  report.target_skipped = skipped_text(problem.target);
  report.source_split = split_text(problem.source);
  report.target_split = split_text(problem.target);
  report.policy = request.policy;
  report.kind = request.kind;
  report.machine = machine.describe();
  report.pes = machine.n_pes();
  report.processes = machine.n_processes();
  report.chares = request.n_chares != 0 ? request.n_chares : request.per_pe * machine.n_pes();
  report.voxel = problem.voxel[0];
  report.source_tets = problem.source.n_tets();
  report.source_edge = typical_edge(problem.source);
  report.targets = problem.target.n_points();
  return problem;
}

}  // namespace m2m_transfer
