#include "m2m/cell_transfer.hpp"

#include "m2m/mesh/workers/scatter.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

/// What the kind takes of the source.
CellForm form_of(TransferKind kind) {
  switch (kind) {
    case TransferKind::nearest:
    case TransferKind::moving_least_squares:
      return CellForm::points;
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

/// The kind and the centrings of the coupling between the Workers.
void choose_coupling(TransferOptions& options, CellForm form) {
  if (form == CellForm::points) return;
  options.source_values = form == CellForm::constant ? Centring::cells : Centring::corners;
  if (is_conservative(options.kind))
    options.target_values = Centring::cells;
  else if (options.kind != TransferKind::projection)
    options.kind = TransferKind::linear;
}

}  // namespace

TaskOf<CellOutcome> transfer_cells(const TetMesh& source, const std::vector<Field>& fields,
                                   const TetMesh& target, std::int32_t n_parts,
                                   PartitionMethod method, TransferOptions options) {
  CellOutcome outcome;
  for (const Field& field : fields)
    outcome.fields.push_back({field.name, field.n_components,
                              std::vector<double>(target.n_tets() * field.n_components, 0.0)});
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
  const TransferKind kind = options.kind;
  const CellForm from = form_of(kind);
  const CellForm to = is_conservative(options.kind) ? CellForm::constant : CellForm::points;
  choose_coupling(options, from);
  check(options);  // before there are Workers
  require_dimensions(kind, options.tolerance, source.dimension, target.dimension);
  DistributedMesh give, take;
  co_await epoch([&] {
    give = scatter_cells(source, fields, n_parts, method, from);
    take = scatter_cells(target, outcome.fields, n_parts, method, to);
  });
  Coupling coupling(give.workers, take.workers, options);
  outcome.search = co_await coupling.search();
  const auto commit = [&take](CouplingId id) { take.workers.broadcast<&Worker::commit>(id); };
  if (!fields.empty()) {
    if (options.on_phase != nullptr) (*options.on_phase)("apply");
    co_await coupling.apply<&Worker::values, &Worker::pending>(commit);
  } else {
    co_await epoch([&] { commit(coupling.id()); });  // the status
  }
  const Outcome all = co_await take.workers.reduce<&Worker::gather>();
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
    give.destroy();
    take.destroy();
  });
  co_return outcome;
}

}  // namespace tess::m2m
