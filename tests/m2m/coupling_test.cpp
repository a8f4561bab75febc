// A piece is a chare: it uses what a chare has, under the same names.
#include "m2m/coupling.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

/// What several codes of an application may have in common stands between the chare and the
/// library.
template <class Code>
class Common : public Chare<Code, Index1>, public Piece<Code> {
 public:
  [[nodiscard]] MeshView mesh_view() const { return {}; }
};
class Own : public Common<Own> {};
static_assert(std::is_default_constructible_v<Own>);

/// Functions of a program, which its pieces call: a base class that had these names would hide
/// them.
int sides(int n) {
  return n;
}
int project(int n) {
  return n;
}
int ask_on(int n) {
  return n;
}

/// Takes values, and then counts itself by a message to itself.
class Counted : public Chare<Counted, Index1>, public Piece<Counted> {
 public:
  void load(const MeshPart& part) {
    part_ = part;
    values_.assign(part.points.size(), index().x);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<const double> give() const { return values_; }
  [[nodiscard]] std::span<double> take() {
    return std::span(values_).first(static_cast<std::size_t>(part_.n_owned));
  }
  void start_round(CouplingId id) { m2m_give<Counted, &Counted::give, &Counted::take>(id); }
  void received(CouplingId /*coupling*/) { self().send<&Counted::count>(); }
  void count() { n_received_ += sides(project(ask_on(1))); }
  void total(Callback<int> target) { contribute(sum, n_received_, std::move(target)); }
  /// Of the points that the piece owns.
  void count_equal(double value, Callback<std::int64_t> target) {
    contribute(sum, std::int64_t{std::ranges::count(take(), value)}, std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, values_, n_received_);
  }

 private:
  MeshPart part_;
  std::vector<double> values_;
  int n_received_ = 0;
};

/// Pieces of the box 0 ≤ x < length.
ArrayProxy<Counted> counted(std::int32_t n, double length = 1) {
  const auto array = create<Counted>(range(n));
  TetMesh mesh = kuhn_mesh({3});
  for (Point& p : mesh.points) p[0] *= length;
  const auto parts = mesh_parts(mesh, n, PartitionMethod::curve);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Counted::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

Task apply_three_times(int& n_received) {
  ArrayProxy<Counted> source, target;
  co_await epoch([&] { source = counted(2), target = counted(5); });
  Coupling coupling(source, target);
  co_await coupling.search();
  for (int k = 0; k < 3; ++k) co_await coupling.apply<&Counted::give, &Counted::take>();
  n_received = co_await target.reduce<&Counted::total>();
}

/// Most pieces of the target are outside of the source.
Task give_three_rounds(int& n_received, std::int64_t& n_filled, std::uint64_t& n_outside) {
  ArrayProxy<Counted> source, target;
  co_await epoch([&] { source = counted(2, 0.1), target = counted(8); });
  Coupling coupling(source, target, {.policy = UseValue{42}});
  SearchSummary summary;
  for (int k = 0; k < 2; ++k) summary = co_await coupling.search();
  n_outside = summary.tally.count(Status::outside);
  co_await epoch([&] {
    for (int k = 0; k < 3; ++k) source.broadcast<&Counted::start_round>(coupling.id());
  });
  n_received = co_await target.reduce<&Counted::total>();
  n_filled = co_await target.reduce<&Counted::count_equal>(42.0);
}

/// A pure source that leaves out n_owned.
class Unowned : public Chare<Unowned, Index1>, public Piece<Unowned> {
 public:
  void load(const MeshPart& part) { part_ = part; }
  [[nodiscard]] MeshView mesh_view() const {
    return {part_.points, part_.tets, part_.point_ids, part_.tet_ids};
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_);
  }

 private:
  MeshPart part_;
};

/// From pieces of the box 0 ≤ x < 0.5 that own no point, or from pieces without points.
Task search_unowned(bool has_points, TransferKind kind, const OutsidePolicy& policy) {
  ArrayProxy<Unowned> source;
  ArrayProxy<Counted> target;
  co_await epoch([&] {
    source = create<Unowned>(range(2));
    target = counted(3);
    TetMesh mesh = kuhn_mesh({3});
    for (Point& p : mesh.points) p[0] *= 0.5;
    const auto parts = mesh_parts(mesh, 2, PartitionMethod::curve);
    for (std::int32_t k = 0; k < 2 && has_points; ++k)
      source[{k}].send<&Unowned::load>(parts[static_cast<std::size_t>(k)]);
  });
  Coupling coupling(source, target, {.policy = policy, .kind = kind});
  co_await coupling.search();
}

}  // namespace

TEST_CASE("a source that owns no point is refused where points need the nearest vertex", "[m2m]") {
  const auto result = [](bool has_points, TransferKind kind, const OutsidePolicy& policy) {
    const test::Machine machine{.pes = 3, .seed = 5};
    return machine.run([=] { return search_unowned(has_points, kind, policy); });
  };
  for (const TransferKind kind : {TransferKind::nearest, TransferKind::linear}) {
    const test::Result refused = result(true, kind, Nearest{});
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.failure(), Contains("set MeshView::n_owned in the source"));
    CHECK(result(false, kind, Nearest{}).ok());  // nothing to own
  }
  CHECK(result(true, TransferKind::linear, Keep{}).ok());
}

TEST_CASE("a round that pieces start reaches those that no source piece gives values", "[m2m]") {
  test::for_seeds(0, test::n_seeds(50), [](std::uint64_t seed) {
    int n_received = 0;
    std::int64_t n_filled = 0;
    std::uint64_t n_outside = 0;
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    machine.run([&] { return give_three_rounds(n_received, n_filled, n_outside); })
        .require_success();
    REQUIRE(n_received == 3 * 8);
    REQUIRE(n_outside > 0);
    REQUIRE(n_filled == static_cast<std::int64_t>(n_outside));
  });
}

TEST_CASE("a piece sends to itself as any chare does", "[m2m]") {
  int n_received = 0;
  REQUIRE(tests::run("pes=3", [&] { return apply_three_times(n_received); }).exit_code == 0);
  CHECK(n_received == 3 * 5);
}
