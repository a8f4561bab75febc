// Misuses of couplings, each of which must end the job with one clear line and an exit code other
// than 0; run by misuse.sh.
//
//     test_coupling_misuse NAME_OF_THE_MISUSE KIND
#include "m2m/coupling.hpp"
#include "m2m/coupling_weights.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/overset.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace {

using namespace tess;
using namespace tess::m2m;

class Patch;

/// Applies the coupling again when it is told to, on the PE of the main coroutine.
class Again : public Group<Again> {
 public:
  static inline Coupling<Patch, Patch>* coupling = nullptr;
  Task apply();
};

class Patch : public Chare<Patch>, public Piece<Patch> {
 public:
  void load(const MeshPart& part) {
    part_ = part;
    values_.assign(part.points.size(), 1);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<const double> give() const { return values_; }
  [[nodiscard]] std::span<double> take() {
    return std::span(values_).first(static_cast<std::size_t>(part_.n_owned));
  }
  /// Keeps a tetrahedron with its corners.
  void shrink() {
    const Tet tet = part_.tets[0];
    MeshPart small;
    for (const VertexId v : tet) {
      small.points.push_back(part_.points[static_cast<std::size_t>(v)]);
      small.point_ids.push_back(part_.point_ids[static_cast<std::size_t>(v)]);
    }
    small.tets = {{0, 1, 2, 3}};
    small.tet_ids = {part_.tet_ids[0]};
    small.n_owned = 4;
    small.n_own_tets = 1;
    load(small);
  }
  void number_alike() { part_.point_ids.assign(part_.point_ids.size(), 7); }
  void number_tets_alike() { part_.tet_ids.assign(part_.tet_ids.size(), 7); }
  void show_as(ElementProxy<Patch> other) { other.send<&Patch::load>(part_); }
  void vanish() { load({}); }
  void forget() { values_.clear(); }
  void go_on(GroupProxy<Again> again) { again_ = again; }
  void received(CouplingId /*coupling*/) {
    if (again_) (*again_)[PeId{0}].send<&Again::apply>();
  }
  /// All points are fringe.
  void cut() {
    const std::vector<std::uint8_t> on_outer(part_.points.size(), 1);
    blanking_.cut(mesh_view(), {}, on_outer);
  }
  [[nodiscard]] std::span<const double> flags() const { return blanking_.flags(); }
  [[nodiscard]] std::span<double> offered(CouplingId from) { return blanking_.offered(from); }
  void settle(CouplingId from) { blanking_.settle(mesh_view(), from, status(from), 1); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(part_, values_);  // without `couplings`
  }

 private:
  MeshPart part_;
  std::vector<double> values_;
  std::optional<GroupProxy<Again>> again_;
  Blanking blanking_;
};

Task Again::apply() {
  co_await coupling->apply<&Patch::give, &Patch::take>();
}

ArrayProxy<Patch> patches(std::int32_t n_cubes, std::int32_t n) {
  const auto array = create<Patch>(range(n));
  const auto parts = mesh_parts(kuhn_mesh({n_cubes}), n, PartitionMethod::curve, 2);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Patch::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

/// Collects the weights of another mesh than the one that was searched.
Task collect_too_late(std::string name, ArrayProxy<Patch> source, ArrayProxy<Patch> target,
                      Coupling<Patch, Patch>& coupling) {
  if (name == "weights_meanwhile") {
    const TaskOf<SearchSummary> search = coupling.search();
    (void)co_await collect_weights(coupling, 125, 64);
  }
  const ArrayProxy<Patch> other = name == "weights_shrunk_source" ? source : target;
  co_await epoch([&] { other.broadcast<&Patch::shrink>(); });
  (void)co_await collect_weights(coupling, 125, 64);
}

/// Settles the fringe without flags, or once more with the same.
Task settle_alone(std::string name, ArrayProxy<Patch> source, ArrayProxy<Patch> target,
                  Coupling<Patch, Patch>& coupling) {
  co_await epoch([&] {
    source.broadcast<&Patch::cut>();
    target.broadcast<&Patch::cut>();
  });
  if (name == "settled_twice") {
    co_await coupling.apply<&Patch::flags, &Patch::offered>();
    co_await epoch([&] { target.broadcast<&Patch::settle>(coupling.id()); });
  }
  co_await epoch([&] { target.broadcast<&Patch::settle>(coupling.id()); });
}

Task misuse(std::string name, TransferKind kind) {
  ArrayProxy<Patch> source, target;
  co_await epoch([&] { source = patches(4, 3), target = patches(3, 2); });
  if (name == "same_ids") co_await epoch([&] { source[{1}].send<&Patch::number_alike>(); });
  if (name == "same_tet_ids")
    co_await epoch([&] { source[{1}].send<&Patch::number_tets_alike>(); });
  if (name == "same_tets") co_await epoch([&] { source[{0}].send<&Patch::show_as>(source[{1}]); });
  Coupling coupling(source, target, {.kind = kind});
  if (name == "two_first_searches") {
    const auto first = coupling.search();
    co_await coupling.search();
  }
  co_await coupling.search();
  if (name == "two_searches") {
    const auto first = coupling.search();
    co_await coupling.search();
  }
  if (name == "search_meanwhile") {
    const Task first = coupling.apply<&Patch::give, &Patch::take>();
    co_await coupling.search();
  }
  if (name == "apply_meanwhile") {
    const auto first = coupling.search();
    co_await coupling.apply<&Patch::give, &Patch::take>();
  }
  if (name == "destroy_in_search") {
    const auto first = coupling.search();
    co_await epoch([&] { coupling.destroy(); });
  }
  if (name == "destroy_in_apply") {
    const Task first = coupling.apply<&Patch::give, &Patch::take>();
    co_await epoch([&] { coupling.destroy(); });
  }
  if (name == "no_arrays") {
    Coupling<Patch, Patch> none;
    co_await none.search();
  }
  if (name == "source_ended") co_await epoch([&] { source.destroy(); });
  if (name == "target_ended") {
    co_await epoch([&] { target.destroy(); });
    co_await coupling.search();
  }
  if (name == "copy_destroyed" || name == "copy_searched") {
    Coupling copy = coupling;
    co_await epoch([&] { copy.destroy(); });
    if (name == "copy_searched") co_await coupling.search();
  }
  if (name == "source_gone") co_await epoch([&] { source[{1}].destroy(); });
  if (name == "shrunk") co_await epoch([&] { source.broadcast<&Patch::shrink>(); });
  if (name.starts_with("weights_")) co_await collect_too_late(name, source, target, coupling);
  if (name.starts_with("settled_")) co_await settle_alone(name, source, target, coupling);
  if (name == "vanished") co_await epoch([&] { source.broadcast<&Patch::vanish>(); });
  if (name == "forgotten") co_await epoch([&] { source[{1}].send<&Patch::forget>(); });
  if (name == "source_moved" || name == "target_moved") {
    const ArrayProxy<Patch> moved = name == "source_moved" ? source : target;
    co_await epoch([&] {
      moved[{0}].migrate_to(PeId{1});
      moved[{1}].migrate_to(PeId{0});
    });
  }
  if (name == "apply_in_received") {
    Again::coupling = &coupling;
    const auto again = create<Again>(each_pe);
    co_await epoch([&] { target.broadcast<&Patch::go_on>(again); });
  }
  if (name == "apply_in_last") {
    const auto again = [&](CouplingId /*coupling*/) {
      Task second = coupling.apply<&Patch::give, &Patch::take>();
    };
    co_await coupling.apply<&Patch::give, &Patch::take>(again);
  }
  co_await coupling.apply<&Patch::give, &Patch::take>();
  print("no misuse\n");
}

int run_misuse(int argc, char** argv) {
  Setup setup = take_options(argc, argv);
  const std::string name = argc > 1 ? argv[1] : "";
  const TransferKind kind = parse_transfer_kind(argc > 2 ? argv[2] : "");
  return run(setup, [&] { return misuse(name, kind); });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return run_misuse(argc, argv); });
}
