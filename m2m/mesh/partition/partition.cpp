#include "m2m/mesh/partition/partition.hpp"

#include "m2m/mesh/checks/mesh_findings.hpp"
#include "m2m/mesh/partition/curve_cut.hpp"
#include "runtime/base/mpi_turn.hpp"
#include "runtime/core/error.hpp"

#include <cstdint>
#include <cstdlib>
#include <zoltan.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace tess::m2m {
namespace {

/// While an object lives, the leak checker ignores what Open MPI allocates and keeps. Open MPI
/// unloads its plug-ins before the checker runs, so suppressions by name do not match.
#ifdef __SANITIZE_ADDRESS__
using IgnoreLeaks = __lsan::ScopedDisabler;
#else
struct IgnoreLeaks {
  IgnoreLeaks() noexcept {}
};
#endif

/// Initialises MPI as a singleton if it is not initialised yet; it is then finalised at exit. The
/// caller has a turn.
void need_mpi() {
  int up = 0;
  MPI_Initialized(&up);
  if (up != 0) return;
  const IgnoreLeaks of_init;
  // A single process needs no daemon. Open MPI would start one and wait for it, for at least half a
  // second.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS) {
    fail(ErrorCode::environment,
         "MPI_Init_thread failed, but Zoltan needs MPI; use one part per mesh, or start with "
         "mpirun");
  }
  std::atexit([] {
    const IgnoreLeaks of_finalize;
    int down = 0;
    MPI_Finalized(&down);
    if (down == 0) MPI_Finalize();
  });
}

void check(int code, const char* call) {
  if (code != ZOLTAN_OK && code != ZOLTAN_WARN)
    fail(ErrorCode::environment, "Zoltan: ", call, " failed with code ", code);
}

/// A mesh that an application makes may not have passed validate().
void refuse_bad_ids(const TetMesh& mesh) {
  MeshFindings findings;
  findings.dimension = mesh.dimension;
  findings.add_points(0, mesh.points);
  findings.add_corners(0, mesh.tets, static_cast<GlobalId>(mesh.n_points()));
  findings.refuse_bad_ids(mesh.name, static_cast<GlobalId>(mesh.n_points()));
}

std::vector<std::int32_t> parts_on_curve(const TetMesh& mesh, std::int32_t n_parts) {
  const HilbertCube cube(bounds(mesh));
  std::vector<std::uint64_t> cells(mesh.n_tets());
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    cells[t] = cube.cell(mean_of_corners(corners_of(mesh.points, mesh.tets[t])));
  CurveCut cut(mesh.n_tets(), n_parts);
  while (!cut.is_done()) cut.refine(cut.counts(cells));
  return cut.parts(cells);
}

std::vector<Point> centroids(const TetMesh& mesh) {
  std::vector<Point> result(mesh.n_tets());
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    for (const VertexId v : mesh.tets[t]) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        result[t][axis] += 0.25 * mesh.points[static_cast<std::size_t>(v)][axis];
    }
  }
  return result;
}

const std::vector<Point>& objects(void* centres) {
  return *static_cast<const std::vector<Point>*>(centres);
}

/// Owns a Zoltan context.
class Zoltan {
 public:
  Zoltan() : context_(Zoltan_Create(MPI_COMM_SELF)) {
    if (context_ == nullptr) fail(ErrorCode::environment, "Zoltan: Zoltan_Create failed");
  }
  ~Zoltan() { Zoltan_Destroy(&context_); }
  Zoltan(const Zoltan&) = delete;
  Zoltan& operator=(const Zoltan&) = delete;

  void set(const char* name, const std::string& value) {
    check(Zoltan_Set_Param(context_, name, value.c_str()), name);
  }
  [[nodiscard]] Zoltan_Struct* get() { return context_; }

 private:
  Zoltan_Struct* context_;
};

void give_objects(Zoltan& zoltan, std::vector<Point>& centres) {
  Zoltan_Set_Num_Obj_Fn(
      zoltan.get(), [](void* data, int*) { return static_cast<int>(objects(data).size()); },
      &centres);
  Zoltan_Set_Obj_List_Fn(
      zoltan.get(),
      [](void* data, int, int, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int, float*, int*) {
        for (std::size_t i = 0; i < objects(data).size(); ++i)
          ids[i] = static_cast<ZOLTAN_ID_TYPE>(i);
      },
      &centres);
  Zoltan_Set_Num_Geom_Fn(
      zoltan.get(), [](void*, int*) { return 3; }, nullptr);
  Zoltan_Set_Geom_Multi_Fn(
      zoltan.get(),
      [](void* data, int, int, int n, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int, double* out, int*) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            out[3 * i + axis] = objects(data)[ids[i]][axis];
        }
      },
      &centres);
}

}  // namespace

std::vector<std::int32_t> partition(const TetMesh& mesh, std::int32_t n_parts,
                                    PartitionMethod method) {
  if (n_parts < 1)
    fail(ErrorCode::bad_argument, "cannot cut a mesh into ", n_parts, " parts; choose at least 1");
  if (mesh.n_tets() > INT32_MAX) {
    fail(ErrorCode::bad_mesh, mesh.name, ": has ", mesh.n_tets(),
         " tetrahedra, but Zoltan accepts at most 2147483647 from one process; split the mesh");
  }
  refuse_bad_ids(mesh);
  std::vector<std::int32_t> parts(mesh.n_tets(), 0);
  if (n_parts == 1 || mesh.tets.empty()) return parts;
  if (method == PartitionMethod::curve) return parts_on_curve(mesh, n_parts);
  std::vector<Point> centres = centroids(mesh);
  const detail::MpiTurn turn;  // Zoltan is not reentrant, either
  need_mpi();
  float version = 0;
  check(Zoltan_Initialize(0, nullptr, &version), "Zoltan_Initialize");
  Zoltan zoltan;
  zoltan.set("DEBUG_LEVEL", "0");
  zoltan.set("LB_METHOD", method == PartitionMethod::rcb ? "RCB" : "HSFC");
  zoltan.set("NUM_GLOBAL_PARTS", std::to_string(n_parts));
  zoltan.set("NUM_GID_ENTRIES", "1");
  zoltan.set("NUM_LID_ENTRIES", "0");
  zoltan.set("OBJ_WEIGHT_DIM", "0");
  zoltan.set("RETURN_LISTS", "PARTS");
  give_objects(zoltan, centres);

  int changes = 0, n_gid = 0, n_lid = 0, n_import = 0, n_export = 0;
  ZOLTAN_ID_PTR import_gids = nullptr, import_lids = nullptr, export_gids = nullptr,
                export_lids = nullptr;
  int *import_procs = nullptr, *import_parts = nullptr, *export_procs = nullptr,
      *export_parts = nullptr;
  const int code = Zoltan_LB_Partition(
      zoltan.get(), &changes, &n_gid, &n_lid, &n_import, &import_gids, &import_lids, &import_procs,
      &import_parts, &n_export, &export_gids, &export_lids, &export_procs, &export_parts);
  for (int i = 0; i < n_export; ++i) parts[export_gids[i]] = export_parts[i];
  Zoltan_LB_Free_Part(&import_gids, &import_lids, &import_procs, &import_parts);
  Zoltan_LB_Free_Part(&export_gids, &export_lids, &export_procs, &export_parts);
  check(code, "Zoltan_LB_Partition");
  if (n_export != static_cast<int>(mesh.n_tets())) {
    fail(ErrorCode::environment, "Zoltan assigned only ", n_export, " of ", mesh.n_tets(),
         " tetrahedra to parts");
  }
  return parts;
}

}  // namespace tess::m2m
