#include "apps/m2m_transfer/input/problem.hpp"

#include "apps/m2m_transfer/input/part.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/error.hpp"
#include "runtime/more/when.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace m2m_transfer {
namespace {

/// Refuses voxels so small that a cell index of a mesh exceeds 32 bits.
void check_voxel(double voxel, const Problem& problem) {
  double farthest = 0;
  for (const RunMesh& mesh : problem.meshes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      farthest = std::max({farthest, std::abs(mesh.survey.census.bounds.lo[axis]),
                           std::abs(mesh.survey.census.bounds.hi[axis])});
  const double least = farthest * 0x1p-30;
  if (voxel < least)
    fail(ErrorCode::bad_argument, "--voxel ", voxel, " is too small for coordinates up to ",
         farthest, "; it must be at least ", least);
}

void read_motions(const Request& request, const std::vector<std::string>& names, Problem& problem) {
  if (!request.moves.empty() && request.repeat > 1)
    fail(ErrorCode::bad_argument,
         "--repeat repeats one search, and --move changes it; give --steps with --move");
  for (const std::string& text : request.moves) {
    StepMotion one = parse_motion(text, names, problem.pairs.front().target);
    RunMesh& mesh = problem.meshes[one.mesh];
    set_centre(one, mesh.survey.census.bounds);
    mesh.motions.push_back(one);
  }
}

/// Samples a mesh that PE 0 holds: also one that needs no values, so that a formula that is not
/// finite there is found before the run.
void sample_fields(Problem& problem, std::size_t m) {
  RunMesh& mesh = problem.meshes[m];
  for (std::size_t f = 0; f < problem.formulas.size(); ++f) {
    Field field = sample(*mesh.mesh, problem.field_names[f], problem.formulas[f]);
    if (problem.partition == PartitionMethod::curve) continue;
    if (!needs_values(m, problem.pairs)) std::ranges::fill(field.values, 0.0);
    mesh.fields.push_back(std::move(field));
  }
}

/// Surveys a mesh; fields only if the domain of the formulas is known.
Task read_one(Problem& problem, std::size_t m) {
  RunMesh& mesh = problem.meshes[m];
  if (problem.partition == PartitionMethod::curve && mesh.part.empty() &&
      is_read_in_ranges(mesh.name)) {
    std::vector<FormulaField> fields;
    for (std::size_t f = 0; f < problem.formulas.size(); ++f)
      fields.push_back({problem.field_names[f], problem.domain});
    mesh.survey = co_await survey(mesh.name, std::move(fields));
    co_return;
  }
  mesh.mesh = read_part(mesh.name, mesh.part).mesh();
  mesh.name = mesh.mesh->name;
  mesh.survey = survey(*mesh.mesh);
  sample_fields(problem, m);
}

/// Fields that a file has do not get here.
Formula formula_of(const std::string& name, const Aabb& domain, const std::string& source) {
  try {
    return make_formula(name, domain);
  } catch (const Error& error) {
    if (source.starts_with("kuhn:")) throw;
    fail(error.code(), error.what(), "; ", source, " holds no field of that name");
  }
}

/// The first source is surveyed before the others: the formulas depend on its bounds. It is sampled
/// when it is placed.
Task read_meshes(const Request& request, Problem& problem) {
  const std::size_t first = problem.pairs.front().source;
  co_await read_one(problem, first);
  RunMesh& source = problem.meshes[first];
  problem.domain = source.survey.census.bounds;
  problem.field_names = split_names(request.fields);
  for (const std::string& name : problem.field_names)
    problem.formulas.push_back(formula_of(name, problem.domain, source.name));
  if (source.mesh) sample_fields(problem, first);
  std::vector<Task> tasks;
  for (std::size_t m = 0; m < problem.meshes.size(); ++m)
    if (m != first) tasks.push_back(read_one(problem, m));
  co_await tess::when_all(std::move(tasks));
}

/// The edge of a cube with the volume of six average tetrahedra, 1/N for kuhn:N, or of a square with
/// the area of two average triangles.
double typical_edge(const MeshSurvey& mesh) {
  const double each = mesh.volume / static_cast<double>(mesh.n_tets);
  return mesh.dimension == 3   ? std::cbrt(6 * each)
         : mesh.dimension == 2 ? std::sqrt(2 * each)
                               : each;
}

TransferReport report_of(const Problem& problem, const Pair& pair, const Request& request) {
  TransferReport report;
  const RunMesh& source = problem.source_of(pair);
  const RunMesh& target = problem.target_of(pair);
  report.source = source.name;
  report.target = target.name;
  const auto elements_of = [](const auto& survey) -> OtherElements {
    return {
        .skipped = survey.skipped,
        .split = survey.split,
        .unused = unused_text(survey.census.n_unused, static_cast<std::size_t>(survey.n_points))};
  };
  report.source_elements = elements_of(source.survey);
  report.target_elements = elements_of(target.survey);
  if (source.name == target.name && source.mesh)
    report.source_elements.coincident = coincident_text(*source.mesh);
  if (source.mesh) report.source_elements.repeated = repeated_text(*source.mesh);
  report.policy = request.policy;
  report.kind = request.kind;
  report.machine = machine().describe();
  report.pes = machine().n_pes();
  report.processes = machine().n_processes();
  report.chares = request.chares();
  report.voxel = problem.voxel[0];
  report.source_tets = static_cast<std::size_t>(source.survey.n_tets);
  report.source_edge = typical_edge(source.survey);
  report.source_dimension = source.survey.dimension;
  report.targets = static_cast<std::size_t>(target.survey.n_points);
  return report;
}

}  // namespace

std::int32_t Request::chares() const {
  return n_chares != 0 ? n_chares : per_pe * machine().n_pes();
}

void check_kind(TransferKind kind, const Request& request) {
  if (!is_conservative(kind)) return;
  const auto refuse = [&](const std::string& option, const char* remedy) {
    fail(ErrorCode::bad_argument, option, " is for kinds that interpolate, and ", name_of(kind),
         " has no donors; ", remedy);
  };
  if (request.clamp) refuse("--clamp", "leave it out, or give another --kind");
  if (request.policy == "nearest")
    refuse("--policy nearest", "give keep or value:V, or another --kind");
}

TaskOf<Problem> load(Request request) {
  Problem problem;
  problem.policy = parse_policy(request.policy);
  problem.partition = parse_partition_method(request.partition);
  problem.kind = parse_transfer_kind(request.kind);
  check_kind(problem.kind, request);
  problem.tolerance = request.tolerance;
  problem.clamp = request.clamp;
  problem.order = request.order;
  problem.repeat = request.repeat;
  problem.steps = request.steps;
  std::vector<std::string> names{request.source, request.target};
  names.insert(names.end(), request.more.begin(), request.more.end());
  problem.pairs = parse_pairs(request.pairs, names);
  if (request.repeat > 1 && is_written_after_read(problem.pairs))
    fail(ErrorCode::bad_argument, "--repeat ", request.repeat,
         " does not work with --pairs that write a mesh after it gave values; give --steps");
  if (names.size() > 2 && request.pairs.empty())
    fail(ErrorCode::bad_argument, names.size(),
         " meshes are given, but no --pairs; give for example --pairs A:B,B:C");
  for (const std::string& name : names) problem.meshes.push_back({.name = name});
  problem.meshes[0].part = request.source_part;
  problem.meshes[1].part = request.target_part;
  co_await read_meshes(request, problem);
  read_motions(request, names, problem);
  if (request.voxel > 0) check_voxel(request.voxel, problem);
  problem.voxel = {request.voxel, request.voxel, request.voxel};
  for (const Pair& pair : problem.pairs)
    problem.reports.push_back(report_of(problem, pair, request));
  co_return problem;
}

void bring_targets(Problem& problem) {
  for (std::size_t m = 0; m < problem.meshes.size(); ++m) {
    if (!is_written(m, problem.pairs)) continue;
    RunMesh& mesh = problem.meshes[m];
    if (!mesh.mesh) mesh.mesh = read_mesh_or_surface(mesh.name);
    if (mesh.mesh->n_points() != static_cast<std::size_t>(mesh.survey.n_points))
      fail(ErrorCode::bad_file, mesh.name, ": has ", mesh.mesh->n_points(), " vertices, and had ",
           mesh.survey.n_points, " when the run began; do not write it during a run");
    for (const RigidMotion& motion : mesh.made) move_points(mesh.mesh->points, motion);
  }
}

std::int32_t halo_for(TransferKind kind, std::size_t mesh, const std::vector<Pair>& pairs) {
  std::int32_t layers = 0;
  for (const Pair& pair : pairs) {
    if (pair.source == mesh) layers = std::max(layers, source_halo_layers(kind));
    if (pair.target == mesh) layers = std::max(layers, target_halo_layers(kind));
  }
  return layers;
}

std::optional<double> largest_second_derivative(const std::string& field, const Aabb& domain) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side = std::max(side, domain.hi[axis] - domain.lo[axis]);
  if (!(side > 0)) side = 1;
  if (field == "linear") return 0;
  // exp(-|r|²) has its largest second derivative, -2, at r = 0; r = 4/side times the position.
  if (field == "gaussian") return 2 * 16 / (side * side);
  // The product of three sines is the mean of four plane waves with the wave vectors k (1, ±1, ±1).
  // Along a unit vector v their squares sum to 4 k² |v|²; the corners of a cube of extrema reach
  // k².
  if (field == "sin") return std::pow(2 * std::numbers::pi / side, 2);
  return std::nullopt;
}

}  // namespace m2m_transfer
