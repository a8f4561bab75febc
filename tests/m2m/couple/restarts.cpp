// Couplings of every kind in a run that stops at a checkpoint, and in the run that goes on from it.
// restarts.sh compares their results with those of a run that does not stop.
//
//     test_coupling_restarts FOLDER HOW
//       whole     three steps, and four more
//       save      three steps, and a checkpoint
//       resume    a checkpoint at once, and the four more
//       early     a checkpoint while a search is under way, which waits for it, and the rest
//       lose      as save, but a source piece is destroyed before the checkpoint
//       lost      goes on from that
#include "m2m/coupling.hpp"
#include "m2m/field.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "runtime/checkpoint.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace tess;
using namespace tess::m2m;

/// After the checkpoint the target lies elsewhere, so that a search would change the results.
class Zone : public Chare<Zone>, public Piece<Zone> {
 public:
  void load(const MeshPart& part) {
    part_ = part;
    taken_.assign(static_cast<std::size_t>(part.n_owned), -7);
    step(0);
  }
  void step(int number) {
    given_.clear();
    for (const Point& p : part_.points)
      given_.push_back(std::sin(3 * p[0] + number) * std::cos(2 * p[1]) + p[2] * number);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<const double> given() const { return given_; }
  [[nodiscard]] std::span<double> taken() { return taken_; }
  /// Rounds of several couplings end in any order, so each has a place of its own.
  [[nodiscard]] std::span<double> late(CouplingId id) {
    std::vector<double>& values = late_[id];
    values.resize(taken_.size());
    return values;
  }
  void mirror() {
    for (Point& p : part_.points) p = {-p[0], -p[1], -p[2]};
  }
  void hop(int by) { migrate_to(PeId{(my_pe().value + by) % n_pes()}); }
  void give(CouplingId id) { m2m_give<Zone, &Zone::given, &Zone::late>(id); }
  void gather(Callback<std::vector<double>> target) {
    std::vector<double> all = taken_;
    for (const auto& [id, values] : late_) all.insert(all.end(), values.begin(), values.end());
    contribute(in_order(concatenate), std::move(all), std::move(target));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, given_, taken_, late_);
  }

 private:
  MeshPart part_;
  std::vector<double> given_, taken_;
  std::map<CouplingId, std::vector<double>> late_;
};

struct State {
  ArrayProxy<Zone> source, target;
  std::vector<Coupling<Zone, Zone>> couplings{};
  int step = 0;
  std::uint64_t hash = result_hash({});
};

ArrayProxy<Zone> zones(const TetMesh& mesh, std::int32_t n) {
  const auto array = create<Zone>(range(n));
  const auto parts = mesh_parts(mesh, n, PartitionMethod::curve, 2);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Zone::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

/// The source covers x < 0.6. A coupling is saved that was not searched.
Task make(State& state) {
  TetMesh mesh = kuhn_mesh({4, 0.2});
  for (Point& p : mesh.points) p[0] *= 0.6;
  co_await epoch([&] {
    state.source = zones(mesh, 4);
    state.target = zones(kuhn_mesh({5, 0.1}), 6);
  });
  for (const TransferKind kind : all_transfer_kinds) {
    CouplingOptions options{.policy = UseValue{42}, .kind = kind};
    if (kind == TransferKind::linear) options.policy = Nearest{};
    if (!is_conservative(kind) && kind != TransferKind::moving_least_squares)
      options.tolerance = 0.1;
    state.couplings.emplace_back(state.source, state.target, options);
    co_await state.couplings.back().search();
  }
  state.couplings.emplace_back(state.target, state.source);
}

Task look(State& state) {
  const auto values = co_await state.target.reduce<&Zone::gather>();
  state.hash = result_hash(values, state.hash);
}

/// Pieces hop between the search and the applications.
Task steps(State& state, int last) {
  while (state.step < last) {
    ++state.step;
    co_await epoch([&] {
      state.source.broadcast<&Zone::hop>(state.step);
      state.target.broadcast<&Zone::hop>(2);
      state.source.broadcast<&Zone::step>(state.step);
    });
    for (std::size_t k = 0; k + 1 < state.couplings.size(); ++k) {
      co_await state.couplings[k].apply<&Zone::given, &Zone::taken>();
      co_await look(state);
    }
  }
}

/// A round that some pieces start before the checkpoint, and the others after it.
Task give(const State& state, std::int32_t first, std::int32_t end) {
  co_await epoch([&] {
    for (const auto& coupling : state.couplings)
      for (std::int32_t k = first; k < end && coupling.id() != CouplingId{}; ++k)
        state.source[{k}].send<&Zone::give>(coupling.id());
  });
}

/// The rest of the run. At its end all couplings search again.
Task go_on(State& state) {
  const auto mirror = [&] { state.target.broadcast<&Zone::mirror>(); };
  co_await epoch(mirror);
  co_await give(state, 1, 4);
  co_await steps(state, 6);
  co_await epoch(mirror);
  Coupling<Zone, Zone> copy = state.couplings.front();
  Task first = state.couplings.front().apply<&Zone::given, &Zone::taken>();
  Task second = copy.apply<&Zone::given, &Zone::taken>();
  co_await first;
  co_await second;
  for (auto& coupling : state.couplings) {
    const SearchSummary found = co_await coupling.search();
    for (const std::uint64_t count : found.tally.counts)
      state.hash = result_hash(std::vector{static_cast<double>(count)}, state.hash);
  }
  co_await steps(state, 7);
  co_await epoch([&] {
    for (auto& coupling : state.couplings) coupling.destroy();
  });
  print("hash ", state.hash, "\n");
}

Task run_as(std::string folder, std::string how) {
  State state;
  if (how == "resume" || how == "lost") {
    state = co_await restart<State>(folder);
    co_await checkpoint(folder, state);
    if (how == "lost")
      co_await steps(state, 4);
    else
      co_await go_on(state);
    co_return;
  }
  co_await make(state);
  if (how == "early") {
    auto search = state.couplings.front().search();
    co_await checkpoint(folder, state);
    co_await search;
    co_await go_on(state);
    co_return;
  }
  co_await steps(state, 3);
  if (how == "lose")
    co_await epoch([&] { state.source[{2}].destroy(); });
  else
    co_await give(state, 0, 1);
  if (how == "whole") {
    co_await go_on(state);
  } else {
    co_await checkpoint(folder, state);
    print("saved\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    if (argc != 3)
      tess::fail(tess::ErrorCode::bad_argument, "usage: test_coupling_restarts FOLDER HOW");
    return tess::run(setup, [&] { return run_as(argv[1], argv[2]); });
  });
}
