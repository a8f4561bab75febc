// Programs that couple two codes by the library, each with pieces of its own that migrate, run at
// the same time, are empty, or are born and end. Every one checks its values against a closed form.
// Run on threads, the simulated machine and under mpirun by coupled_codes.sh.
//
//     test_coupled_codes            all of them
//     test_coupled_codes NAME…      some of them
#include "collide/collider.hpp"
#include "m2m/coupling.hpp"
#include "m2m/coupling_weights.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/balance.hpp"
#include "runtime/more/when.hpp"
#include "tests/support/resident.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tess;
using namespace tess::m2m;

double truth(const Point& p, int step, int component) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2] + step * p[0] + 7 * component * p[1];
}

using ValueOf = std::map<GlobalId, std::vector<double>>;
struct JoinValues {
  ValueOf operator()(ValueOf a, const ValueOf& b) const {
    a.insert(b.begin(), b.end());
    return a;
  }
};

/// A piece of one of the two codes. It gives `out` and `more_out`, and takes `in` and `more_in`.
template <int side>
struct Code : Chare<Code<side>>, Piece<Code<side>> {
  void load(const MeshPart& its_part, int components) {
    part = its_part;
    n_components = components;
    forget();
    step(0);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part); }
  void step(int number) {
    out.clear();
    more_out.clear();
    for (const Point& p : part.points)
      for (int c = 0; c < n_components; ++c) {
        out.push_back(truth(p, number, c));
        more_out.push_back(truth(p, number + 100, c));
      }
  }
  /// A field whose integral is not that of its interpolant elsewhere.
  void curve() {
    for (std::size_t v = 0; v < part.points.size(); ++v)
      out[v] = std::sin(5 * part.points[v][0]) * part.points[v][1] + part.points[v][2];
  }
  void forget() {
    in.assign(static_cast<std::size_t>(part.n_owned * n_components), -1e9);
    more_in = in;
  }
  void move(const Point& way) {
    for (Point& p : part.points)
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += way[axis];
  }
  void hop(int by) { this->migrate_to(PeId{(my_pe().value + by) % n_pes()}); }
  /// Counts values that are wrong; `both`: of more_in, too.
  void check(int number, bool both, Callback<std::uint64_t> n_wrong) {
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const auto of = static_cast<std::size_t>(n_components);
      const Point& p = part.points[i / of];
      const int c = static_cast<int>(i % of);
      n += !(std::abs(in[i] - truth(p, number, c)) < 1e-11) ? 1U : 0U;
      if (both) n += !(std::abs(more_in[i] - truth(p, number + 100, c)) < 1e-9) ? 1U : 0U;
    }
    this->contribute(sum, n, std::move(n_wrong));
  }
  void gather(Callback<ValueOf> target) {
    ValueOf all;
    const auto of = static_cast<std::size_t>(n_components);
    for (std::size_t v = 0; v * of < in.size(); ++v)
      all[part.point_ids[v]] = {in.begin() + std::ptrdiff_t(v * of),
                                in.begin() + std::ptrdiff_t((v + 1) * of)};
    this->contribute(JoinValues{}, std::move(all), std::move(target));
  }
  void start_round(CouplingId id) {
    this->template m2m_give<Code<1>, &Code<side>::out, &Code<1>::in>(id);
  }
  void received(CouplingId) { ++n_received; }
  void count_received(Callback<std::uint64_t> total) {
    this->contribute(sum, std::exchange(n_received, 0), std::move(total));
  }
  /// Balances, and goes on when all pieces of this code have come here.
  void balance(Callback<std::uint64_t> when_done) {
    done = std::move(when_done);
    this->at_sync();
  }
  void resume_from_sync() { this->contribute(sum, std::uint64_t{1}, std::move(done)); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(this->couplings, part, n_components, out, more_out, in, more_in, n_received, done);
  }

  MeshPart part;
  int n_components = 1;
  std::vector<double> out, more_out, in, more_in;
  std::uint64_t n_received = 0;
  Callback<std::uint64_t> done;
};
using Left = Code<0>;
using Right = Code<1>;

/// Pieces of a mesh; from `n` on to `n_all` they are empty.
template <class C>
ArrayProxy<C> pieces(const TetMesh& mesh, std::int32_t n, std::int32_t n_all = 0,
                     int components = 1, std::int32_t halo = 0) {
  const auto parts = mesh_parts(mesh, n, PartitionMethod::curve, halo);
  const auto array = create<C>(range(std::max(n, n_all)));
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].template send<&C::load>(parts[static_cast<std::size_t>(k)], components);
  return array;
}

template <class C>
Task expect(ArrayProxy<C> array, int step, bool both = false) {
  const std::uint64_t n = co_await array.template reduce<&C::check>(step, both);
  TESS_CHECK(n == 0, n, " wrong values in step ", step);
}

template <class C>
TaskOf<ValueOf> values_of(ArrayProxy<C> array) {
  co_return co_await array.template reduce<&C::gather>();
}

const TetMesh left_mesh = kuhn_mesh({6, 0.2});
const TetMesh right_mesh = kuhn_mesh({7, 0.1});

struct Two {
  ArrayProxy<Left> left;
  ArrayProxy<Right> right;
};
Task make(Two& codes, std::int32_t n_left, std::int32_t n_right, int components = 1,
          std::int32_t halo = 0) {
  co_await epoch([&] {
    codes.left = pieces<Left>(left_mesh, n_left, 0, components, halo);
    codes.right = pieces<Right>(right_mesh, n_right, 0, components, halo);
  });
}
Task end(Two codes) {
  co_await epoch([&] {
    codes.left.destroy();
    codes.right.destroy();
  });
}
Task step(Two codes, int number) {
  co_await epoch([&] {
    codes.left.broadcast<&Left::step>(number);
    codes.right.broadcast<&Right::step>(number);
    codes.left.broadcast<&Left::forget>();
    codes.right.broadcast<&Right::forget>();
  });
}

/// Three components, and pieces of another number on each side.
Task components() {
  Two codes;
  co_await make(codes, 3, 7, 3);
  Coupling there(codes.left, codes.right);
  Coupling back(codes.right, codes.left);
  co_await there.search();
  co_await back.search();
  for (int k = 1; k <= 3; ++k) {
    co_await step(codes, k);
    co_await there.apply<&Left::out, &Right::in>();
    co_await back.apply<&Right::out, &Left::in>();
    co_await expect(codes.right, k);
    co_await expect(codes.left, k);
  }
  co_await end(codes);
}

/// Pieces of both codes migrate while values and searches are under way.
Task migration() {
  for (const TransferKind kind :
       {TransferKind::linear, TransferKind::second_order, TransferKind::conservative}) {
    Two codes;
    co_await make(codes, 5, 6, 1, 2);
    Coupling there(codes.left, codes.right, {.kind = kind});
    for (int k = 1; k <= 8; ++k) {
      const auto hop = [&] {
        codes.left.broadcast<&Left::hop>(k);
        codes.right.broadcast<&Right::hop>(k + 1);
      };
      if (k % 4 == 1) {
        auto search = there.search();
        co_await epoch(hop);
        co_await search;
      }
      co_await step(codes, k);
      Task apply = there.apply<&Left::out, &Right::in>();
      co_await epoch(hop);
      co_await apply;
      co_await expect(codes.right, k);
    }
    co_await end(codes);
  }
}

/// Both codes balance between transfers, and while they are under way.
Task balancing() {
  Two codes;
  co_await make(codes, 6, 8);
  start_balancing(codes.left, {.strategy = "rotate"});
  start_balancing(codes.right, {.strategy = "greedy"});
  Coupling there(codes.left, codes.right);
  Coupling back(codes.right, codes.left);
  co_await there.search();
  co_await back.search();
  for (int k = 1; k <= 6; ++k) {
    co_await step(codes, k);
    Task one = there.apply<&Left::out, &Right::in>(), other = back.apply<&Right::out, &Left::in>();
    Future<std::uint64_t> left_done, right_done;
    codes.left.broadcast<&Left::balance>(left_done.callback());
    codes.right.broadcast<&Right::balance>(right_done.callback());
    (void)co_await left_done;
    (void)co_await right_done;
    co_await one;
    co_await other;
    co_await expect(codes.right, k);
    co_await expect(codes.left, k);
  }
  co_await end(codes);
}

/// A mesh is in three couplings at once, in one of them twice.
Task three_at_once() {
  Two codes;
  co_await make(codes, 4, 5);
  ArrayProxy<Right> third;
  co_await epoch([&] { third = pieces<Right>(kuhn_mesh({4}), 3); });
  Coupling a(codes.left, codes.right), b(codes.left, third);
  Coupling c(codes.left, codes.left);
  auto sa = a.search(), sb = b.search(), sc = c.search();
  co_await sa;
  co_await sb;
  co_await sc;
  for (int k = 1; k <= 4; ++k) {
    co_await step(codes, k);
    Task ta = a.apply<&Left::out, &Right::in>(), tb = b.apply<&Left::out, &Right::in>();
    Task tc = c.apply<&Left::out, &Left::in>();
    co_await tc;
    co_await ta;
    co_await tb;
    co_await expect(codes.right, k);
    co_await expect(third, k);
    co_await expect(codes.left, k);
  }
  co_await epoch([&] { third.destroy(); });
  co_await end(codes);
}

/// Several fields by one coupling at once, in both directions at once, and again before the last
/// ended.
Task many_fields() {
  Two codes;
  co_await make(codes, 4, 6);
  Coupling there(codes.left, codes.right);
  Coupling back(codes.right, codes.left);
  co_await there.search();
  co_await back.search();
  for (int k = 1; k <= 4; ++k) {
    co_await step(codes, k);
    std::vector<Task> tasks;
    for (int again = 0; again < 3; ++again) {
      tasks.push_back(there.apply<&Left::out, &Right::in>());
      tasks.push_back(there.apply<&Left::more_out, &Right::more_in>());
      tasks.push_back(back.apply<&Right::out, &Left::in>());
      tasks.push_back(back.apply<&Right::more_out, &Left::more_in>());
    }
    co_await when_all(std::move(tasks));
    co_await expect(codes.right, k, true);
    co_await expect(codes.left, k, true);
  }
  co_await end(codes);
}

/// One mesh moves and is searched again while another pair applies.
Task motion() {
  Two codes;
  co_await make(codes, 4, 6);
  ArrayProxy<Right> moving;
  co_await epoch([&] { moving = pieces<Right>(kuhn_mesh({3}), 4); });
  Coupling still(codes.left, codes.right),
      to_moving(codes.left, moving, {.policy = UseValue{-7e5}});
  co_await still.search();
  co_await to_moving.search();
  for (int k = 1; k <= 5; ++k) {
    co_await step(codes, k);
    Task apply = still.apply<&Left::out, &Right::in>();
    co_await epoch([&] { moving.broadcast<&Right::move>(Point{k % 2 == 1 ? -0.5 : 0.5, 0, 0}); });
    const SearchSummary found = co_await to_moving.search();
    co_await to_moving.apply<&Left::out, &Right::in>();
    co_await apply;
    co_await expect(codes.right, k);
    const std::uint64_t n_outside = found.tally.counts[static_cast<std::size_t>(Status::outside)];
    TESS_CHECK(n_outside == (k % 2 == 1 ? 32U : 0U), n_outside, " points outside in step ", k);
    const ValueOf values = co_await values_of(moving);
    std::uint64_t n_filled = 0;
    for (const auto& [id, row] : values) n_filled += row[0] == -7e5 ? 1U : 0U;
    TESS_CHECK(n_filled == n_outside, n_filled, " points have the value of the policy");
  }
  co_await epoch([&] { moving.destroy(); });
  co_await end(codes);
}

/// Pieces without points, on both sides; then one piece has all.
Task empty_pieces() {
  for (const auto& [n_left, n_right] : {std::pair{2, 3}, std::pair{1, 1}})
    for (const TransferKind kind : all_transfer_kinds) {
      Two codes;
      co_await epoch([&] {
        codes.left = pieces<Left>(left_mesh, n_left, 5, 1, 2);
        codes.right = pieces<Right>(right_mesh, n_right, 6, 1, 2);
      });
      Coupling there(codes.left, codes.right, {.kind = kind});
      co_await there.search();
      co_await step(codes, 1);
      co_await there.apply<&Left::out, &Right::in>();
      if (kind == TransferKind::linear || kind == TransferKind::second_order ||
          kind == TransferKind::conservative)
        co_await expect(codes.right, 1);
      co_await end(codes);
    }
}

/// Pieces of a sparse array end, and others are born for the same mesh; then it is searched again.
Task births() {
  Two codes;
  co_await epoch([&] {
    codes.left = pieces<Left>(left_mesh, 4);
    codes.right = create<Right>(sparse);
  });
  Coupling there(codes.left, codes.right);
  std::int32_t born = 0;
  for (int k = 1; k <= 5; ++k) {
    const std::int32_t n = 2 + k;
    const auto parts = mesh_parts(right_mesh, n, PartitionMethod::curve);
    co_await epoch([&] {
      for (std::int32_t i = 0; i < n; ++i) codes.right[{born + i}].insert_on(PeId{i % n_pes()});
    });
    co_await epoch([&] {
      for (std::int32_t i = 0; i < n; ++i)
        codes.right[{born + i}].send<&Right::load>(parts[static_cast<std::size_t>(i)], 1);
    });
    co_await there.search();
    co_await step(codes, k);
    co_await there.apply<&Left::out, &Right::in>();
    co_await expect(codes.right, k);
    co_await epoch([&] {
      for (std::int32_t i = 0; i < n; ++i) codes.right[{born + i}].destroy();
    });
    born += n;
  }
  co_await end(codes);
}

/// The integral of the linear interpolant.
double integral(const TetMesh& mesh, const ValueOf& values) {
  double total = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    double of_corners = 0;
    for (const VertexId v : mesh.tets[t]) of_corners += values.at(v)[0];
    total += std::abs(signed_volume(mesh, t)) * of_corners / 4;
  }
  return total;
}

/// A consistent and a conservative coupling of one pair apply at once.
Task two_kinds() {
  Two codes;
  co_await make(codes, 4, 5, 1, 1);
  Coupling mean(codes.left, codes.right, {.kind = TransferKind::conservative}),
      point(codes.left, codes.right);
  Coupling to_itself(codes.left, codes.left);
  auto one = mean.search(), other = point.search(), third = to_itself.search();
  co_await one;
  co_await other;
  co_await third;
  co_await step(codes, 1);
  co_await epoch([&] { codes.left.broadcast<&Left::curve>(); });
  Task a = mean.apply<&Left::out, &Right::in>();
  Task b = point.apply<&Left::more_out, &Right::more_in>();
  Task c = to_itself.apply<&Left::out, &Left::in>();
  co_await a;
  co_await b;
  co_await c;
  const ValueOf given = co_await values_of(codes.left), taken = co_await values_of(codes.right);
  const double want = integral(left_mesh, given), got = integral(right_mesh, taken);
  TESS_CHECK(std::abs(got - want) < 1e-12, "the integral changes from ", want, " to ", got);
  co_await end(codes);
}

/// A code applies the weights by hand, and gets the bits of the coupling.
Task weights_by_hand() {
  Two codes;
  co_await make(codes, 4, 5);
  Coupling there(codes.left, codes.right);
  co_await there.search();
  const WeightMatrix matrix =
      co_await collect_weights(there, std::ssize(left_mesh.points), std::ssize(right_mesh.points));
  co_await step(codes, 2);
  co_await there.apply<&Left::out, &Right::in>();
  const ValueOf taken = co_await values_of(codes.right);
  std::vector<double> values, by_library(right_mesh.n_points());
  for (const Point& p : left_mesh.points) values.push_back(truth(p, 2, 0));
  apply(matrix, values, 1, by_library);
  for (std::size_t row = 0; row < matrix.rows.n_rows(); ++row) {
    const auto columns = matrix.rows.columns_of(row);
    const auto weights = matrix.rows.weights_of(row);
    double by_hand = 0, total = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      by_hand += weights[k] * values[static_cast<std::size_t>(columns[k])];
      total += weights[k];
    }
    const double of_coupling = taken.at(static_cast<GlobalId>(row))[0];
    TESS_CHECK(by_library[row] == of_coupling, "row ", row, ": ", by_library[row], " and ",
               of_coupling);
    TESS_CHECK(std::abs(by_hand - of_coupling) < 1e-12 && std::abs(total - 1) < 1e-12, "row ", row,
               ": ", by_hand, " by hand, ", of_coupling, "; weights sum to ", total);
  }
  co_await end(codes);
}

/// A coupling is destroyed and made again, while another of the same pieces goes on.
Task destroyed() {
  Two codes;
  co_await make(codes, 4, 5);
  Coupling lasting(codes.left, codes.right), passing(codes.left, codes.right);
  co_await lasting.search();
  for (int k = 1; k <= 5; ++k) {
    co_await step(codes, k);
    co_await passing.search();
    co_await passing.apply<&Left::more_out, &Right::more_in>();
    Task apply = lasting.apply<&Left::out, &Right::in>();
    co_await epoch([&] { passing.destroy(); });
    co_await apply;
    co_await expect(codes.right, k, true);
  }
  co_await end(codes);
}

/// The voxels of a search end before the next one, which makes them again, also while values are
/// under way.
Task retired() {
  Two codes;
  co_await make(codes, 4, 5);
  Coupling there(codes.left, codes.right);
  co_await there.search();
  for (int k = 1; k <= 3; ++k) {
    co_await step(codes, k);
    Task apply = there.apply<&Left::out, &Right::in>();
    for (int call = 0; call < 2; ++call)  // the first one finds them used
      co_await epoch([&] { there.collider().retire(); });
    co_await apply;
    co_await expect(codes.right, k);
    co_await there.search();
  }
  co_await end(codes);
}

/// Pieces start rounds, and some pieces of the other code are empty. Most of its points are outside,
/// or none is. Each round reaches the pieces that the application of the whole reaches, and with the
/// same bits.
Task rounds_to(double reach, TransferKind kind) {
  const std::uint64_t n_targets = 12, n_rounds = 3;
  TetMesh left_end = left_mesh;
  for (Point& p : left_end.points) p[0] *= reach;
  Two codes;
  co_await epoch([&] {
    codes.left = pieces<Left>(left_end, 5, 0, 1, 1);
    codes.right = pieces<Right>(right_mesh, 9, static_cast<std::int32_t>(n_targets), 1, 1);
  });
  Coupling there(codes.left, codes.right, {.policy = UseValue{-7e5}, .kind = kind});
  for (int k = 1; k <= 2; ++k) {
    co_await there.search();
    co_await step(codes, k);
    co_await there.apply<&Left::out, &Right::in>();
    const ValueOf whole = co_await values_of(codes.right);
    co_await epoch([&] {
      codes.left.broadcast<&Left::hop>(k);
      codes.right.broadcast<&Right::hop>(k + 1);
      codes.right.broadcast<&Right::forget>();
    });
    co_await epoch([&] {
      for (std::uint64_t round = 0; round < n_rounds; ++round)
        codes.left.broadcast<&Left::start_round>(there.id());
    });
    const ValueOf by_rounds = co_await values_of(codes.right);
    TESS_CHECK(by_rounds == whole, "rounds of pieces give other values in step ", k);
    const std::uint64_t n = co_await codes.right.reduce<&Right::count_received>();
    TESS_CHECK(n == (1 + n_rounds) * n_targets, n, " calls of received() in step ", k);
  }
  co_await end(codes);
}
Task rounds() {
  for (const double reach : {0.2, 1.0})
    for (const TransferKind kind : {TransferKind::linear, TransferKind::conservative})
      co_await rounds_to(reach, kind);
}

/// Ten thousand applications: the same bits, and flat memory.
Task repeats() {
  Two codes;
  co_await epoch([&] {
    codes.left = pieces<Left>(kuhn_mesh({2}), 2);
    codes.right = pieces<Right>(kuhn_mesh({3}), 3);
  });
  Coupling there(codes.left, codes.right);
  co_await there.search();
  co_await there.apply<&Left::out, &Right::in>();
  const ValueOf first = co_await values_of(codes.right);
  tess::test::Growth growth(10'000);
  for (int round = 1; round <= growth.n_rounds(); ++round) {
    co_await there.apply<&Left::out, &Right::in>();
    growth.after(round);
  }
  const ValueOf last = co_await values_of(codes.right);
  TESS_CHECK(first == last, "other values after 10000 applications");
  TESS_CHECK(growth.bytes() < 1 << 20, "memory grows by ", growth.bytes(), " bytes");
  co_await expect(codes.right, 0);
  co_await end(codes);
}

using Program = Task (*)();
const std::vector<std::pair<std::string, Program>> programs{{"components", components},
                                                            {"migration", migration},
                                                            {"balancing", balancing},
                                                            {"three_at_once", three_at_once},
                                                            {"many_fields", many_fields},
                                                            {"motion", motion},
                                                            {"empty_pieces", empty_pieces},
                                                            {"births", births},
                                                            {"two_kinds", two_kinds},
                                                            {"weights_by_hand", weights_by_hand},
                                                            {"destroyed", destroyed},
                                                            {"retired", retired},
                                                            {"rounds", rounds},
                                                            {"repeats", repeats}};

Task run_programs(std::vector<std::string> names) {
  for (const auto& [name, program] : programs) {
    if (!names.empty() && std::ranges::find(names, name) == names.end()) continue;
    co_await program();
    print(name, ": holds\n");
  }
}

int run_all(int argc, char** argv) {
  Setup setup = take_options(argc, argv);
  return run(setup, [&] { return run_programs(std::vector<std::string>(argv + 1, argv + argc)); });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return run_all(argc, argv); });
}
