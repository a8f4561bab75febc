#include "m2m/placement.hpp"

#include "m2m/io/ranges/mesh_ranges.hpp"
#include "m2m/mesh/checks/mesh_extent.hpp"
#include "m2m/mesh/workers/placer.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/error.hpp"
#include "runtime/more/when.hpp"

#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

/// Runs a step and all that it causes.
template <auto Step, class... Args>
Task step(GroupProxy<Placer> placers, Args... args) {
  co_await epoch([&] { placers.broadcast<Step>(std::move(args)...); });
}

void throw_first(const FirstError& error) {
  if (error.key >= 0) throw Error(static_cast<ErrorCode>(error.code), error.message);
}

/// The bounds of the mesh. Corners may still be under way.
Aabb checked_bounds(const PlacerReport& report, const PlacerSetup& setup) {
  throw_first(report.error);
  report.findings.refuse_bad_ids(setup.shown_name, setup.n_points);
  return report.findings.bounds;
}

/// Begins to read, and ends when all messages about corners have arrived. `whole`: the mesh if its
/// ranges are sent, otherwise null.
Task read_ranges(GroupProxy<Placer> placers, const TetMesh* whole, Callback<PlacerReport> target) {
  co_await epoch([&] {
    if (whole == nullptr) {
      placers.broadcast<&Placer::read>(RangeLoad{}, target);
      return;
    }
    const std::int64_t n_pes = tess::n_pes();
    const auto cut = [&](const auto& list, std::int32_t pe) {
      const auto n = static_cast<std::int64_t>(list.size());
      return std::vector(list.begin() + n * pe / n_pes, list.begin() + n * (pe + 1) / n_pes);
    };
    for (std::int32_t pe = 0; pe < n_pes; ++pe)
      placers[PeId{pe}].send<&Placer::read>(RangeLoad{cut(whole->points, pe), cut(whole->tets, pe)},
                                            target);
  });
}

/// A mesh that was read and checked.
struct ReadMesh {
  MeshCensus census;
  CellCounts counts;          // for the first round of a CurveCut
  std::vector<Task> corners;  // of the messages about corners, some of which may be under way
};

TaskOf<ReadMesh> read_and_measure(GroupProxy<Placer> placers, PlacerSetup setup,
                                  const TetMesh* whole) {
  ReadMesh mesh;
  Future<PlacerReport> read;
  mesh.corners.push_back(read_ranges(placers, whole, read.callback()));
  const PlacerReport report = co_await read;
  std::exception_ptr refused;
  try {
    mesh.census.bounds = checked_bounds(report, setup);
  } catch (...) {
    refused = std::current_exception();
  }
  if (refused) {
    co_await when_all(std::move(mesh.corners));
    std::rethrow_exception(refused);
  }

  PlacerReport measured = co_await placers.reduce<&Placer::measure>(mesh.census.bounds);
  const MeshFindings& findings = measured.findings;
  findings.refuse_bad_shapes(setup.shown_name, static_cast<std::uint64_t>(setup.n_tets));
  mesh.census.n_flat = findings.n_flat;
  mesh.census.n_inverted = findings.n_inverted;
  mesh.counts = std::move(measured.counts);
  co_return mesh;
}

// A step whose messages the PEs count begins before they have arrived; so every PE goes on as soon
// as it can.
TaskOf<MeshCensus> lead(GroupProxy<Placer> placers, PlacerSetup setup, const TetMesh* whole) {
  ReadMesh mesh = co_await read_and_measure(placers, setup, whole);
  CurveCut cut(static_cast<std::uint64_t>(setup.n_tets), setup.n_parts);
  if (!cut.is_done()) cut.refine(mesh.counts);
  while (!cut.is_done()) {
    const PlacerReport sum = co_await placers.reduce<&Placer::count>(cut);
    cut.refine(sum.counts);
  }

  co_await step<&Placer::send_tets>(placers, cut);
  co_await when_all(std::move(mesh.corners));
  Future<PlacerReport> finished;
  co_await step<&Placer::answer_parts>(placers, finished.callback());
  if (setup.halo_layers > 0) {
    for (std::int32_t layer = 0; layer < setup.halo_layers; ++layer) {
      co_await step<&Placer::ask_around>(placers);
      co_await step<&Placer::ask_halo_points>(placers);
    }
    co_await step<&Placer::finish>(placers);
    co_await step<&Placer::load_workers>(placers);
  }
  const PlacerReport built = co_await finished;
  throw_first(built.error);
  mesh.census.n_unused = built.n_unused;
  co_return mesh.census;
}

/// `whole`: the mesh if its ranges are sent, otherwise null.
TaskOf<MeshSurvey> survey_ranges(PlacerSetup setup, const TetMesh* whole) {
  MeshSurvey out;
  const GroupProxy<Placer> placers = create<Placer>(each_pe, setup);
  std::exception_ptr error;
  try {
    ReadMesh mesh = co_await read_and_measure(placers, setup, whole);
    co_await when_all(std::move(mesh.corners));
    const PlacerReport report = co_await placers.reduce<&Placer::finish_survey>();
    throw_first(report.error);
    out.census = mesh.census;
    out.census.n_unused = report.n_unused;
    out.longest_edge = std::sqrt(report.extent.longest_squared);
    out.volume = report.extent.volume.total();
  } catch (...) {
    error = std::current_exception();
  }
  co_await epoch([&] { placers.destroy(); });
  if (error) std::rethrow_exception(error);
  out.n_points = setup.n_points;
  out.n_tets = setup.n_tets;
  co_return out;
}

/// `whole`: the mesh if its ranges are sent, otherwise null.
TaskOf<PlacedMesh> place_ranges(PlacerSetup setup, const TetMesh* whole) {
  PlacedMesh placed;
  setup.workers = create<Worker>(range(setup.n_parts));
  const GroupProxy<Placer> placers = create<Placer>(each_pe, setup);
  std::exception_ptr error;
  try {
    placed.census = co_await lead(placers, setup, whole);
  } catch (...) {
    error = std::current_exception();
  }
  if (error) {
    const auto clear = [&] {
      placers.destroy();
      setup.workers.destroy();
    };
    co_await epoch(clear);
    std::rethrow_exception(error);
  }
  placers.destroy();  // the Workers need not wait for it
  placed.mesh = {setup.workers, setup.n_parts, setup.fields.size(), setup.halo_layers,
                 setup.dimension};
  placed.n_points = setup.n_points;
  placed.n_tets = setup.n_tets;
  co_return placed;
}

PlacerSetup setup_of(std::string shown_name, PlaceOptions options,
                     std::vector<FormulaField> fields) {
  if (options.n_parts < 1)
    fail(ErrorCode::bad_argument, "cannot cut a mesh into ", options.n_parts,
         " parts; choose at least 1");
  if (options.halo_layers < 0)
    fail(ErrorCode::bad_argument, "a halo of ", options.halo_layers, " layers; choose 0 or more");
  for (const FormulaField& field : fields) (void)make_formula(field.name, field.domain);
  PlacerSetup setup;
  setup.shown_name = std::move(shown_name);
  setup.n_parts = options.n_parts;
  setup.halo_layers = options.halo_layers;
  setup.fields = std::move(fields);
  return setup;
}

/// Fills in the sizes of a mesh in memory.
void take_sizes(const TetMesh& mesh, PlacerSetup& setup) {
  refuse_bad_counts(mesh.name, mesh.n_points(), mesh.n_tets(), skipped_text(mesh), mesh.dimension);
  setup.dimension = mesh.dimension;
  setup.n_points = static_cast<GlobalId>(mesh.n_points());
  setup.n_tets = static_cast<GlobalId>(mesh.n_tets());
}

/// Fills in the name and the sizes of a file, and checks what concerns all of it. Returns null if
/// it cannot be read in ranges.
std::unique_ptr<MeshRanges> take_ranges(const std::string& name, PlacerSetup& setup) {
  std::unique_ptr<MeshRanges> ranges = open_ranges(name, RangeCheck::all);
  if (ranges == nullptr) return ranges;
  setup.n_points = ranges->n_points;
  setup.n_tets = ranges->n_tets;
  refuse_bad_counts(name, static_cast<std::uint64_t>(setup.n_points),
                    static_cast<std::uint64_t>(setup.n_tets), ranges->skipped);
  setup.name = name;
  return ranges;
}

}  // namespace

TaskOf<PlacedMesh> place(const TetMesh* mesh, PlaceOptions options,
                         std::vector<FormulaField> fields) {
  PlacerSetup setup = setup_of(mesh->name, options, fields);
  take_sizes(*mesh, setup);
  setup.lacks_elements = !mesh->elements.of_tet.empty();
  if (setup.lacks_elements && options.keeps_elements) {
    PlacedMesh placed{{}, setup.n_points, setup.n_tets, validate(*mesh)};
    std::vector<Field> sampled;
    for (const FormulaField& field : fields)
      sampled.push_back(sample(*mesh, field.name, make_formula(field.name, field.domain)));
    co_await epoch([&] {
      placed.mesh =
          scatter(*mesh, sampled, options.n_parts, PartitionMethod::curve, options.halo_layers);
    });
    co_return placed;
  }
  co_return co_await place_ranges(std::move(setup), mesh);
}

TaskOf<PlacedMesh> place(std::string name, PlaceOptions options, std::vector<FormulaField> fields) {
  PlacerSetup setup = setup_of(name, options, fields);
  if (take_ranges(name, setup) == nullptr) {
    const TetMesh mesh = read_mesh(name);
    co_return co_await place(&mesh, options, std::move(fields));
  }
  co_return co_await place_ranges(std::move(setup), nullptr);
}

bool is_read_in_ranges(const std::string& name) {
  try {
    return open_ranges(name, RangeCheck::all) != nullptr;
  } catch (const Error&) {
    return false;
  }
}

TaskOf<MeshSurvey> survey(std::string name, std::vector<FormulaField> fields) {
  PlacerSetup setup = setup_of(name, {}, std::move(fields));
  setup.is_survey = true;
  if (auto ranges = take_ranges(name, setup)) {
    std::string skipped = ranges->skipped;
    ranges.reset();
    MeshSurvey out = co_await survey_ranges(std::move(setup), nullptr);
    out.skipped = std::move(skipped);
    co_return out;
  }
  const TetMesh mesh = read_mesh(name);
  take_sizes(mesh, setup);
  MeshSurvey out = co_await survey_ranges(std::move(setup), &mesh);
  out.skipped = skipped_text(mesh);
  out.split = split_text(mesh);
  co_return out;
}

MeshSurvey survey(const TetMesh& mesh) {
  MeshSurvey out;
  out.census = validate(mesh);
  out.n_points = static_cast<GlobalId>(mesh.n_points());
  out.n_tets = static_cast<GlobalId>(mesh.n_tets());
  MeshExtent extent;
  for (const Tet& tet : mesh.tets) extent.add(corners_of(mesh.points, tet), mesh.dimension);
  out.longest_edge = std::sqrt(extent.longest_squared);
  out.volume = extent.volume.total();
  out.skipped = skipped_text(mesh);
  out.split = split_text(mesh);
  out.dimension = mesh.dimension;
  return out;
}

}  // namespace tess::m2m
