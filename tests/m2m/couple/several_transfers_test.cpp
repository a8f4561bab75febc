// Compares several transfers on the same meshes, one after another or at the same time, with
// transfers in one thread: they give the same bits on every machine and schedule.
#include "m2m/read_mesh.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/m2m/serial_transfer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <array>
#include <functional>

using namespace tess;
using namespace tess::m2m;
using tess::test::transfer_serial;

namespace {

/// A mesh with one field of two components.
struct MeshWithField {
  TetMesh mesh;
  Field field;
};

MeshWithField piece(const char* name, double scale, double offset, const char* formula) {
  MeshWithField p{test::moved_by(read_mesh(name), scale, offset), {"f", 2, {}}};
  const Field scalar = sample(p.mesh, formula, make_formula(formula, bounds(p.mesh)));
  for (const double value : scalar.values) {
    p.field.values.push_back(value);
    p.field.values.push_back(1 - value);
  }
  return p;
}

std::vector<Status> transfer_alone(const MeshWithField& from, MeshWithField& to,
                                   const OutsidePolicy& policy) {
  return transfer_serial(from.mesh, std::span(&from.field, 1), to.mesh, std::span(&to.field, 1),
                         policy)
      .status;
}

/// The values and status of a mesh, gathered in global order.
struct Held {
  std::vector<double> values;
  std::vector<Status> status;
};

Task gather(DistributedMesh mesh, Held* held) {
  const Outcome all = co_await test::gathered(mesh);
  *held = {all.values, all.status};
}

/// The number of parts of the two meshes of a case.
struct Parts {
  std::int32_t a = 0, b = 0;
};

DistributedMesh spread(const MeshWithField& p, std::int32_t n_parts) {
  return scatter(p.mesh, {p.field}, n_parts, PartitionMethod::rcb);
}

TransferOptions options_of(const OutsidePolicy& policy) {
  return {.policy = policy};
}

/// Requires equality. A failure does not print the lists.
void require_same(const Held& got, const MeshWithField& want, const std::vector<Status>& status) {
  const bool same_values = got.values == want.field.values, same_status = got.status == status;
  REQUIRE(same_values);
  REQUIRE(same_status);
}

/// Two meshes and a policy. Each mesh has vertices outside the other.
struct MeshPair {
  MeshWithField a = piece("kuhn:4@0.2", 1, 0, "sin");
  MeshWithField b = piece("kuhn:6@0.1", 1.1, -0.05, "gaussian");
  OutsidePolicy policy{};

  [[nodiscard]] TransferOptions there() const { return options_of(policy); }
  [[nodiscard]] TransferOptions back() const { return options_of(policy); }
};

struct Spread {
  DistributedMesh a, b;
};

Task spread_both(const MeshPair& c, Parts n, Spread* meshes) {
  co_await epoch([&] {
    meshes->a = spread(c.a, n.a);
    meshes->b = spread(c.b, n.b);
  });
}

struct HeldBoth {
  Held a, b;
};

Task gather_both(const Spread* meshes, HeldBoth* held) {
  co_await gather(meshes->a, &held->a);
  co_await gather(meshes->b, &held->b);
}

Task there_and_back_and_there(const MeshPair& c, Parts n, HeldBoth* held) {
  Spread meshes;
  co_await spread_both(c, n, &meshes);
  co_await transfer(meshes.a, meshes.b, c.there());
  co_await transfer(meshes.b, meshes.a, c.back());
  co_await transfer(meshes.a, meshes.b, c.there());
  co_await gather_both(&meshes, held);
}

/// Transfers in both directions at the same time.
Task exchange(const MeshPair& c, Parts n, HeldBoth* held) {
  Spread meshes;
  co_await spread_both(c, n, &meshes);
  auto there = transfer(meshes.a, meshes.b, c.there());
  auto back = transfer(meshes.b, meshes.a, c.back());
  co_await there;
  co_await back;
  co_await gather_both(&meshes, held);
}

/// Transfers from a to two other meshes and to a itself, at the same time.
Task to_two(const MeshPair& c, Parts n, HeldBoth* held) {
  Spread meshes, others;
  co_await spread_both(c, n, &meshes);
  co_await spread_both(c, n, &others);
  auto one = transfer(meshes.a, meshes.b, c.there());
  auto two = transfer(meshes.a, others.b, c.there());
  auto self = transfer(meshes.a, meshes.a, c.there());
  co_await one;
  co_await two;
  co_await self;
  co_await gather(meshes.b, &held->a);
  co_await gather(others.b, &held->b);
}

/// Transfers from two sources that do not overlap to one target, at the same time.
Task from_two(const MeshPair& left, const MeshPair& right, Parts n, HeldBoth* held) {
  Spread meshes, others;
  co_await spread_both(left, n, &meshes);
  co_await spread_both(right, n, &others);
  auto one = transfer(meshes.a, meshes.b, left.there());
  auto two = transfer(others.a, meshes.b, right.there());
  co_await one;
  co_await two;
  co_await gather(meshes.b, &held->a);
}

/// A program, and the check of its result.
struct Scenario {
  std::function<Task(HeldBoth*)> program;
  std::function<void(const HeldBoth&)> judge;
};

/// Runs a scenario on many schedules of the simulated machine, which also migrates Workers, and on
/// threads, with several numbers of parts.
void on_many_schedules(std::uint64_t n_seeds, const std::function<Scenario(Parts)>& make) {
  const auto check_one = [&](Parts n, const auto& run_on_machine) {
    const Scenario check = make(n);
    HeldBoth held;
    run_on_machine([&] { return check.program(&held); });
    check.judge(held);
  };
  test::for_seeds(1, test::n_seeds(n_seeds) + 1, [&](std::uint64_t seed) {
    const test::Machine machine{.pes = std::array{1, 2, 3, 4, 7, 8}[seed % 6], .seed = seed};
    const Parts n{static_cast<std::int32_t>(2 + seed * 5 % 7),
                  static_cast<std::int32_t>(1 + seed * 3 % 8)};
    INFO(n.a << " and " << n.b << " parts");
    check_one(n, [&](const auto& main) { machine.run(main).require_success(); });
  });
  for (const std::int32_t pes : {1, 2, 4}) {
    INFO("threads, " << pes << " PEs");
    check_one({5, 3},
              [&](const auto& main) { REQUIRE(tests::run_threads(pes, main).exit_code == 0); });
  }
}

}  // namespace

TEST_CASE("a transfer there, back and there again gives the bits of three serial transfers",
          "[m2m][several]") {
  for (const OutsidePolicy& policy :
       {OutsidePolicy{Keep{}}, OutsidePolicy{UseValue{3}}, OutsidePolicy{Nearest{}}}) {
    MeshPair c;
    c.policy = policy;
    MeshPair want = c;
    transfer_alone(want.a, want.b, policy);
    const auto a_status = transfer_alone(want.b, want.a, policy);
    const auto b_status = transfer_alone(want.a, want.b, policy);
    on_many_schedules(30, [&](Parts n) {
      return Scenario{[&, n](HeldBoth* held) { return there_and_back_and_there(c, n, held); },
                      [&](const HeldBoth& held) {
                        require_same(held.a, want.a, a_status);
                        require_same(held.b, want.b, b_status);
                      }};
    });
  }
}

TEST_CASE("a mesh can be the source of three concurrent transfers, one of them onto itself",
          "[m2m][several]") {
  MeshPair c;
  c.policy = Nearest{};
  MeshPair want = c;
  const auto status = transfer_alone(want.a, want.b, c.policy);
  on_many_schedules(60, [&](Parts n) {
    return Scenario{[&, n](HeldBoth* held) { return to_two(c, n, held); },
                    [&](const HeldBoth& held) {
                      require_same(held.a, want.b, status);
                      require_same(held.b, want.b, status);
                    }};
  });
}

TEST_CASE("two concurrent transfers into one mesh keep the values of both", "[m2m][several]") {
  MeshPair left;
  left.a = piece("kuhn:4@0.2", 0.45, 0, "sin");
  MeshPair right = left;
  right.a = piece("kuhn:3@0.1", 0.4, 0.55, "linear");
  MeshPair want = left;
  transfer_alone(left.a, want.b, Keep{});
  transfer_alone(right.a, want.b, Keep{});
  on_many_schedules(60, [&](Parts n) {
    return Scenario{[&, n](HeldBoth* held) { return from_two(left, right, n, held); },
                    [&](const HeldBoth& held) { REQUIRE(held.a.values == want.b.field.values); }};
  });
}

TEST_CASE("concurrent transfers both ways read a mesh before or after it is written",
          "[m2m][several]") {
  const MeshPair c;
  std::array<MeshPair, 3> wants{c, c, c};
  transfer_alone(c.a, wants[0].b, Keep{});  // both read before either writes
  transfer_alone(c.b, wants[0].a, Keep{});
  transfer_alone(wants[1].a, wants[1].b, Keep{});
  transfer_alone(wants[1].b, wants[1].a, Keep{});
  transfer_alone(wants[2].b, wants[2].a, Keep{});
  transfer_alone(wants[2].a, wants[2].b, Keep{});
  on_many_schedules(60, [&](Parts n) {
    return Scenario{[&, n](HeldBoth* held) { return exchange(c, n, held); },
                    [&](const HeldBoth& held) {
                      const auto is = [&](const MeshPair& want) {
                        return held.a.values == want.a.field.values &&
                               held.b.values == want.b.field.values;
                      };
                      REQUIRE(std::any_of(wants.begin(), wants.end(), is));
                    }};
  });
}
