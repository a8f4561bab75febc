#include "m2m/cell_transfer.hpp"

#include "m2m/mesh/workers/cell_worker.hpp"
#include "m2m/mesh_parts.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {
namespace {

CellForm form_of(TransferKind kind) {
  switch (kind) {
    case TransferKind::second_order:
    case TransferKind::conservative:
      return CellForm::linear;
    case TransferKind::limited:
    case TransferKind::conservative_bounded:
      return CellForm::limited;
    default:
      return CellForm::constant;
  }
}

/// How the pieces hold a mesh.
struct Layout {
  std::int32_t n_parts = 1, halo_layers = 0;
  PartitionMethod method{};
  CellForm form{};
  bool as_points = false;
};

ArrayProxy<CellWorker> scatter_cells(const TetMesh& mesh, const std::vector<Field>& fields,
                                     const Layout& layout) {
  const auto array = create<CellWorker>(range(layout.n_parts));
  std::vector<MeshPart> parts = mesh_parts(mesh, layout.n_parts, layout.method, layout.halo_layers);
  for (std::int32_t k = 0; k < layout.n_parts; ++k) {
    CellLoad load{
        std::move(parts[static_cast<std::size_t>(k)]), {}, 0, {}, layout.form, layout.as_points};
    for (const Field& field : fields) load.n_components += field.n_components;
    for (const GlobalId id : load.part.tet_ids) {
      const auto tet = static_cast<std::size_t>(id);
      load.elements.push_back(mesh.element_of_tet.empty() ? id : mesh.element_of_tet[tet]);
      for (const Field& field : fields) {
        const double* const row = field.values.data() + tet * field.n_components;
        load.values.insert(load.values.end(), row, row + field.n_components);
      }
    }
    array[{k}].send<&CellWorker::load>(std::move(load));
  }
  return array;
}

/// The kind and the source's values of the coupling between the pieces.
void choose_coupling(TransferOptions& options, CellForm form) {
  if (options.kind == TransferKind::nearest) return;  // between centroids
  options.source_values = form == CellForm::constant ? Centring::cells : Centring::corners;
  if (is_conservative(options.kind))
    options.target_values = Centring::cells;
  else
    options.kind = TransferKind::linear;
}

}  // namespace

TaskOf<CellOutcome> transfer_cells(const TetMesh& source, const std::vector<Field>& fields,
                                   const TetMesh& target, std::int32_t n_parts,
                                   PartitionMethod method, TransferOptions options) {
  CellOutcome outcome;
  for (const Field& field : fields) {
    TESS_CHECK(field.values.size() == source.n_tets() * field.n_components, "field ", field.name,
               ": expected ", source.n_tets() * field.n_components, " values, got ",
               field.values.size());
    outcome.fields.push_back({field.name, field.n_components,
                              std::vector<double>(target.n_tets() * field.n_components, 0.0)});
  }
  if (std::holds_alternative<Nearest>(options.policy) && options.kind != TransferKind::nearest)
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " has no nearest cell for what lies outside: choose policy keep or value for fields in "
         "elements, or kind nearest");
  if (std::holds_alternative<UseValue>(options.policy) && options.kind == TransferKind::nearest)
    fail(
        ErrorCode::bad_argument,
        "kind nearest compares only centroids of elements, and so does not know which lie outside: "
        "choose policy keep or nearest for fields in elements");
  if (options.clamp && options.kind == TransferKind::second_order)
    options.kind = TransferKind::limited;
  const CellForm form = form_of(options.kind);
  const bool interpolates = !is_conservative(options.kind);
  const std::int32_t halo = source_halo_layers(form, !source.element_of_tet.empty());
  const Layout give{n_parts, halo, method, form, options.kind == TransferKind::nearest};
  const Layout take{n_parts, 0, method, CellForm::constant, interpolates};
  choose_coupling(options, form);
  check(options);  // before there are pieces
  ArrayProxy<CellWorker> from, to;
  co_await epoch([&] {
    from = scatter_cells(source, fields, give);
    to = scatter_cells(target, outcome.fields, take);
  });
  Coupling coupling(from, to, options);
  outcome.search = co_await coupling.search();
  if (!fields.empty()) {
    if (options.on_phase != nullptr) (*options.on_phase)("apply");
    co_await coupling.apply<&CellWorker::values, &CellWorker::result>();
  }
  const Outcome all = co_await to.reduce<&CellWorker::gather>(coupling.id());
  outcome.status.resize(target.n_tets());
  const double* row = all.values.data();
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const auto tet = static_cast<std::size_t>(all.points[i]);
    outcome.status[tet] = all.status[i];
    for (Field& field : outcome.fields) {
      std::copy_n(row, field.n_components, field.values.data() + tet * field.n_components);
      row += field.n_components;
    }
  }
  co_await epoch([&] { coupling.destroy(); });
  co_await epoch([&] {
    from.destroy();
    to.destroy();
  });
  co_return outcome;
}

}  // namespace tess::m2m
