// Applications that write one member of the target and overlap, on any machine: by one handle and its
// copy, by two couplings, by a Transfer, while the pieces migrate. Each of them checks its values
// against a closed form, or against the same applications one after the other. turns_test.cpp has
// more orders, but knows the simulated machine only.
#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/when.hpp"
#include "tests/m2m/gathered.hpp"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace {

using namespace tess;
using namespace tess::m2m;

constexpr double nothing = -1e9;

/// A linear field per number, so that every kind gives it up to rounding.
double truth(const Point& p, int field) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2] + field * (1 + p[0]);
}
bool is_near(double a, double b) {
  return std::abs(a - b) < 1e-9;
}

/// One of the fields that a value may be of.
struct Fields {
  std::vector<int> any_of;
};

class Patch : public Chare<Patch>, public Piece<Patch> {
 public:
  void load(const MeshPart& part) {
    part_ = part;
    forget();
    begin(0);
  }
  /// The fields that it gives: `number`, and the next one.
  void begin(int number) {
    ones_.clear();
    twos_.clear();
    for (const Point& p : part_.points) {
      ones_.push_back(truth(p, number));
      twos_.push_back(truth(p, number + 1));
    }
  }
  void forget() {
    taken_.assign(static_cast<std::size_t>(part_.n_owned), nothing);
    taken_by_.clear();
  }
  void hop(int by) { migrate_to(PeId{(my_pe().value + by) % n_pes()}); }

  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<const double> ones() const { return ones_; }
  [[nodiscard]] std::span<const double> twos() const { return twos_; }
  [[nodiscard]] std::span<double> taken() { return taken_; }
  /// A field of each coupling.
  [[nodiscard]] std::span<double> taken_by(CouplingId id) {
    std::vector<double>& values = taken_by_[id];
    values.resize(static_cast<std::size_t>(part_.n_owned), nothing);
    return values;
  }

  /// Counts the values that are of none of these fields.
  void check(Fields fields, Callback<int> n_wrong) {
    contribute(sum, count_wrong(taken_, fields), std::move(n_wrong));
  }
  void check_by(CouplingId id, Fields fields, Callback<int> n_wrong) {
    contribute(sum, count_wrong(taken_by(id), fields), std::move(n_wrong));
  }
  /// The same where the source ends: left of the middle field `left`, right of it the next one.
  void check_halves(int left, Callback<int> n_wrong) {
    int n = 0;
    for (std::size_t v = 0; v < taken_.size(); ++v) {
      const Point& p = part_.points[v];
      const bool is_left = is_near(taken_[v], truth(p, left));
      const bool is_right = is_near(taken_[v], truth(p, left + 1));
      const bool may_be_left = p[0]<0.5 + 1e-9, may_be_right = p[0]> 0.5 - 1e-9;
      n += (is_left && may_be_left) || (is_right && may_be_right) ? 0 : 1;
    }
    contribute(sum, n, std::move(n_wrong));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, ones_, twos_, taken_, taken_by_);
  }

 private:
  [[nodiscard]] int count_wrong(std::span<const double> values, const Fields& fields) const {
    int n = 0;
    for (std::size_t v = 0; v < values.size(); ++v) {
      bool right = false;
      for (const int field : fields.any_of)
        right = right || is_near(values[v], truth(part_.points[v], field));
      n += right ? 0 : 1;
    }
    return n;
  }

  MeshPart part_;
  std::vector<double> ones_, twos_, taken_;
  std::map<CouplingId, std::vector<double>> taken_by_;
};

ArrayProxy<Patch> patches(const TetMesh& mesh, std::int32_t n) {
  const auto array = create<Patch>(range(n));
  const auto parts = mesh_parts(mesh, n, PartitionMethod::curve, 2);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Patch::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}
struct Both {
  ArrayProxy<Patch> source, target;
};
Task begin(Both both, int field) {
  co_await epoch([&] {
    both.source.broadcast<&Patch::begin>(field);
    both.target.broadcast<&Patch::forget>();
  });
}
void hop(Both both, int by) {
  both.source.broadcast<&Patch::hop>(by);
  both.target.broadcast<&Patch::hop>(by + 1);
}

Task expect(ArrayProxy<Patch> target, const Fields& any_of) {
  const int n_wrong = co_await target.reduce<&Patch::check>(any_of);
  TESS_CHECK(n_wrong == 0, n_wrong, " values are not of field ", any_of.any_of.front());
}

/// By a handle and its copy: the task of the first ends after its values, which the second has
/// replaced or not; `last` sees them before; and the values of the second remain.
Task by_copies(TransferKind kind) {
  Both both;
  co_await epoch([&] {
    both = {patches(kuhn_mesh({4, 0.2}), 4), patches(kuhn_mesh({5, 0.1}), 5)};
  });
  Coupling coupling(both.source, both.target, {.kind = kind});
  co_await coupling.search();
  Coupling copy = coupling;
  for (int k = 1; k <= 6; ++k) {
    co_await begin(both, 2 * k);
    Future<int> n_wrong;
    const Fields of_first{{2 * k}}, of_second{{2 * k + 1}}, of_any{{2 * k, 2 * k + 1}};
    Task first = coupling.apply<&Patch::ones, &Patch::taken>(
        [&](CouplingId) { both.target.broadcast<&Patch::check>(of_first, n_wrong.callback()); });
    Task second = (k % 2 == 0 ? copy : coupling).apply<&Patch::twos, &Patch::taken>();
    Task other = coupling.apply<&Patch::ones, &Patch::taken_by>();  // to another member
    co_await epoch([&] { hop(both, k); });
    co_await first;
    const int n = co_await n_wrong;
    TESS_CHECK(n == 0, n, " values are not there when the first application ends, step ", k);
    co_await expect(both.target, of_any);
    co_await second;
    co_await expect(both.target, of_second);
    co_await other;
    const int n_of_other = co_await both.target.reduce<&Patch::check_by>(coupling.id(), of_first);
    TESS_CHECK(n_of_other == 0, n_of_other, " wrong values in another member");
  }
  co_await epoch([&] { coupling.destroy(); });
}

/// Two couplings into one accessor at once, each to a field of its own.
Task to_own_fields(TransferKind kind) {
  Both both;
  ArrayProxy<Patch> other;
  co_await epoch([&] {
    both = {patches(kuhn_mesh({4, 0.2}), 4), patches(kuhn_mesh({5, 0.1}), 5)};
    other = patches(kuhn_mesh({3}), 3);
  });
  const CouplingOptions options{.kind = kind};
  Coupling a(both.source, both.target, options), b(other, both.target, options);
  auto search_a = a.search(), search_b = b.search();
  co_await search_a;
  co_await search_b;
  for (int k = 1; k <= 4; ++k) {
    co_await begin(both, 2 * k);
    co_await epoch([&] { other.broadcast<&Patch::begin>(10 * k); });
    std::vector<Task> tasks;
    for (int again = 0; again < 2; ++again) {
      tasks.push_back(a.apply<&Patch::twos, &Patch::taken_by>());
      tasks.push_back(b.apply<&Patch::twos, &Patch::taken_by>());
      tasks.push_back(a.apply<&Patch::ones, &Patch::taken_by>());
      tasks.push_back(b.apply<&Patch::ones, &Patch::taken_by>());
    }
    co_await epoch([&] { hop(both, k); });
    co_await when_all(std::move(tasks));
    const Fields of_a{{2 * k}}, of_b{{10 * k}};
    const int n_of_a = co_await both.target.reduce<&Patch::check_by>(a.id(), of_a);
    const int n_of_b = co_await both.target.reduce<&Patch::check_by>(b.id(), of_b);
    TESS_CHECK(n_of_a == 0 && n_of_b == 0, n_of_a, " and ", n_of_b, " wrong values, step ", k);
  }
  co_await epoch([&] {
    a.destroy();
    b.destroy();
  });
}

/// Two couplings into one member at once, each for a half of the target: a point outside of a source
/// keeps the value of the other.
Task to_halves(TransferKind kind) {
  TetMesh left = kuhn_mesh({4}), right = kuhn_mesh({5});
  for (Point& p : left.points) p[0] *= 0.5;
  for (Point& p : right.points) p[0] = 0.5 + 0.5 * p[0];
  ArrayProxy<Patch> of_left, of_right, target;
  co_await epoch([&] {
    of_left = patches(left, 3);
    of_right = patches(right, 4);
    target = patches(kuhn_mesh({6}), 5);
  });
  const CouplingOptions options{.kind = kind};
  Coupling a(of_left, target, options), b(of_right, target, options);
  co_await a.search();
  co_await b.search();
  for (int k = 1; k <= 4; ++k) {
    const Both of_one{of_left, target};
    co_await begin(of_one, k);
    co_await epoch([&] { of_right.broadcast<&Patch::begin>(k); });
    Task to_left = a.apply<&Patch::ones, &Patch::taken>();
    Task to_right = b.apply<&Patch::twos, &Patch::taken>();
    co_await epoch([&] { hop(of_one, k); });
    co_await to_right;
    co_await to_left;
    const int n_wrong = co_await target.reduce<&Patch::check_halves>(k);
    TESS_CHECK(n_wrong == 0, n_wrong, " values of the wrong source, step ", k);
  }
  co_await epoch([&] {
    a.destroy();
    b.destroy();
  });
}

/// A Transfer from a mesh to itself, which smooths: each application reads what the one before it
/// has written.
TaskOf<std::vector<double>> smooth(int n_times, bool at_once) {
  const TetMesh mesh = kuhn_mesh({4});
  std::vector<double> field;
  for (const Point& p : mesh.points) field.push_back(std::sin(9 * p[0]) * p[1] + p[2] * p[2]);
  DistributedMesh smoothed;
  co_await epoch([&] {
    smoothed = scatter(mesh, {{"f", 1, field}}, 5, PartitionMethod::curve, 1);
  });
  Transfer transfer(smoothed, smoothed, {.kind = TransferKind::conservative_lumped});
  co_await transfer.search();
  std::vector<Task> tasks;
  for (int n = 0; n < n_times; ++n) {
    tasks.push_back(transfer.apply());
    Task& last = tasks.back();
    if (!at_once) co_await last;
  }
  for (Task& task : tasks) co_await task;
  std::vector<double> values = (co_await test::gathered(smoothed)).values;
  co_await epoch([&] { transfer.destroy(); });
  co_return values;
}

Task apply_all() {
  for (const TransferKind kind :
       {TransferKind::linear, TransferKind::second_order, TransferKind::conservative}) {
    co_await by_copies(kind);
    co_await to_own_fields(kind);
  }
  for (const TransferKind kind : {TransferKind::linear, TransferKind::second_order})
    co_await to_halves(kind);
  const auto want = co_await smooth(4, false);
  TESS_CHECK(want.size() == 125, want.size(), " values of 125");
  for (int again = 0; again < 5; ++again) {
    const auto got = co_await smooth(4, true);
    TESS_CHECK(got == want, "applications of a Transfer at once have other values");
  }
  print("all turns hold\n");
}

}  // namespace

int main(int argc, char** argv) {
  return tess::run(argc, argv, [] { return apply_all(); });
}
