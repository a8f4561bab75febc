// Applications to one member of the target that are started before the first of them is done.
#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

constexpr double nothing = -1;

/// Two fields that are constant, so that every kind gives their values up to rounding.
class Patch : public Chare<Patch, Index1>, public Piece<Patch> {
 public:
  void load(const MeshPart& part) {
    part_ = part;
    ones_.assign(part.points.size(), 1);
    twos_.assign(part.points.size(), 2);
    forget();
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<const double> ones() const { return ones_; }
  [[nodiscard]] std::span<const double> twos() const { return twos_; }
  [[nodiscard]] std::span<double> taken() { return taken_; }
  void forget() { taken_.assign(static_cast<std::size_t>(part_.n_owned), nothing); }
  /// The range of what it has taken.
  void least(Callback<double> target) {
    contribute(min, taken_.empty() ? INFINITY : *std::ranges::min_element(taken_),
               std::move(target));
  }
  void greatest(Callback<double> target) {
    contribute(max, taken_.empty() ? -INFINITY : *std::ranges::max_element(taken_),
               std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, ones_, twos_, taken_);
  }

 private:
  MeshPart part_;
  std::vector<double> ones_, twos_, taken_;
};

ArrayProxy<Patch> patches(std::int32_t n_cubes, std::int32_t n) {
  const auto array = create<Patch>(range(n));
  const auto parts = mesh_parts(kuhn_mesh({n_cubes}), n, PartitionMethod::curve, 1);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Patch::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

struct Range {
  double least = nothing, greatest = nothing;
  [[nodiscard]] bool is(double value) const {
    return std::abs(least - value) < 1e-9 && std::abs(greatest - value) < 1e-9;
  }
};

Task range_of(ArrayProxy<Patch> target, Range* range) {
  range->least = co_await target.reduce<&Patch::least>();
  range->greatest = co_await target.reduce<&Patch::greatest>();
}

/// What the target has after the first of two applications, and after both. They are those of one
/// handle, or of two copies.
struct Seen {
  Range first, both;
};

Task apply_twice(TransferKind kind, bool second_by_copy, Seen& seen) {
  ArrayProxy<Patch> source, target;
  co_await epoch([&] { source = patches(3, 4), target = patches(4, 3); });
  Coupling coupling(source, target, {.kind = kind});
  co_await coupling.search();
  Coupling copy = coupling;
  co_await epoch([&] { target.broadcast<&Patch::forget>(); });
  Task ones = coupling.apply<&Patch::ones, &Patch::taken>();
  Task twos = (second_by_copy ? copy : coupling).apply<&Patch::twos, &Patch::taken>();
  co_await ones;
  co_await range_of(target, &seen.first);
  co_await twos;
  co_await range_of(target, &seen.both);
}

DistributedMesh scatter_with(const TetMesh& mesh, const std::vector<double>& values,
                             std::int32_t n_parts) {
  return scatter(mesh, {{"f", 1, values}}, n_parts, PartitionMethod::curve, 1);
}

/// The numbers of values that are missing when each of two applications is done.
struct Missing {
  std::ptrdiff_t after_first = 0, after_second = 0;
};
Task count_missing(DistributedMesh mesh, std::ptrdiff_t* n) {
  const std::vector<double> values = (co_await test::gathered(mesh)).values;
  *n = std::ranges::count(values, nothing);
}
Task transfer_twice(TransferKind kind, bool second_first, Missing& missing) {
  const TetMesh from = kuhn_mesh({3}), to = kuhn_mesh({4});
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter_with(from, std::vector<double>(from.n_points(), 1), 4);
    target = scatter_with(to, std::vector<double>(to.n_points(), nothing), 3);
  });
  Transfer transfer(source, target, {.kind = kind});
  co_await transfer.search();
  Task first = transfer.apply(), second = transfer.apply();
  if (second_first) {
    co_await second;
    co_await count_missing(target, &missing.after_second);
  }
  co_await first;
  co_await count_missing(target, &missing.after_first);
  if (!second_first) co_await second;
}

/// What comes behind the values of the first application throws; the second one has its turn.
Task apply_after_error(Range& both) {
  ArrayProxy<Patch> source, target;
  co_await epoch([&] { source = patches(3, 4), target = patches(4, 3); });
  Coupling coupling(source, target);
  co_await coupling.search();
  try {
    co_await coupling.apply<&Patch::ones, &Patch::taken>(
        [](CouplingId) { fail(ErrorCode::bad_value, "no"); });
  } catch (const Error&) {
  }
  co_await coupling.apply<&Patch::twos, &Patch::taken>();
  co_await range_of(target, &both);
}

/// A kind that smooths, from a mesh to itself: the second application reads what the first wrote.
Task smooth_twice(bool at_once, std::vector<double>& values) {
  const TetMesh mesh = kuhn_mesh({4});
  std::vector<double> field;
  for (const Point& p : mesh.points) field.push_back(std::sin(9 * p[0]) * p[1] + p[2] * p[2]);
  DistributedMesh smoothed;
  co_await epoch([&] { smoothed = scatter_with(mesh, field, 5); });
  Transfer transfer(smoothed, smoothed, {.kind = TransferKind::conservative_lumped});
  co_await transfer.search();
  Task first = transfer.apply();
  if (!at_once) co_await first;
  Task second = transfer.apply();
  if (at_once) co_await first;
  co_await second;
  values = (co_await test::gathered(smoothed)).values;
}

}  // namespace

TEST_CASE("of two applications to one member each ends after its values, and the later one remains",
          "[m2m][turns]") {
  for (const TransferKind kind : {TransferKind::linear, TransferKind::conservative})
    for (const bool second_by_copy : {false, true})
      test::for_seeds(1, test::n_seeds(30) + 1, [&](std::uint64_t seed) {
        const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
        Seen seen;
        machine.run([&] { return apply_twice(kind, second_by_copy, seen); }).require_success();
        REQUIRE(seen.first.least > 1 - 1e-9);  // the second one may be on its way
        REQUIRE(seen.both.is(2));
      });
}

TEST_CASE("an application whose last step throws passes its turn on", "[m2m][turns]") {
  Seen seen;
  const test::Machine machine{.pes = 3};
  machine.run([&] { return apply_after_error(seen.both); }).require_success();
  CHECK(seen.both.is(2));
}

TEST_CASE("a Transfer that is applied again meanwhile has moved all values when a task is done",
          "[m2m][turns]") {
  for (const TransferKind kind : {TransferKind::linear, TransferKind::conservative})
    for (const bool second_first : {false, true})
      test::for_seeds(1, test::n_seeds(30) + 1, [&](std::uint64_t seed) {
        const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
        Missing missing;
        machine.run([&] { return transfer_twice(kind, second_first, missing); }).require_success();
        REQUIRE(missing.after_first == 0);
        REQUIRE(missing.after_second == 0);
      });
}

TEST_CASE("a Transfer from a mesh to itself reads what its application before has written",
          "[m2m][turns]") {
  std::vector<double> want;
  const test::Machine one{.pes = 1};
  one.run([&] { return smooth_twice(false, want); }).require_success();
  REQUIRE(want.size() == 125);
  test::for_seeds(1, test::n_seeds(30) + 1, [&](std::uint64_t seed) {
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    std::vector<double> got;
    machine.run([&] { return smooth_twice(true, got); }).require_success();
    const bool same = got == want;
    REQUIRE(same);
  });
}
