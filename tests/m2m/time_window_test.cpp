#include "m2m/time_window.hpp"

#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

/// The pressure is linear in space, so that its interpolant has errors in time only.
double height(const Point& p) {
  return 1 + p[0] - 2 * p[1] + 3 * p[2];
}

class Flow : public tess::Chare<Flow, tess::Index1>, public tess::m2m::Piece<Flow> {
 public:
  void load(const MeshPart& part) { part_ = part; }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  void step(double time) {
    pressure.clear(), rate.clear();
    for (const Point& p : part_.points) {
      pressure.push_back(height(p) * std::sin(2 * time));
      rate.push_back(height(p) * 2 * std::cos(2 * time));
    }
    migrate_to(PeId{(my_pe().value + 1) % n_pes()});
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, pressure, rate);
  }

  std::vector<double> pressure, rate;

 private:
  MeshPart part_;
};

class Shell : public tess::Chare<Shell, tess::Index1>, public tess::m2m::Piece<Shell> {
 public:
  tess::m2m::TimeWindow load;  // apply() takes the values of the new sample
  void accept(double time) { load.accept(time); }
  void step(double time) { advance(time, load.at(time)); }
  // …
  void begin(const MeshPart& part, TimeMethod method) {
    part_ = part;
    load = TimeWindow(static_cast<std::size_t>(part.n_owned), method);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(part_); }
  [[nodiscard]] std::span<double> rates() { return load.rates(); }
  void advance(double time, const std::vector<double>& values) {
    for (std::size_t v = 0; v < values.size(); ++v)
      error_ = std::max(error_, std::abs(values[v] - height(part_.points[v]) * std::sin(2 * time)));
    migrate_to(PeId{(my_pe().value + 2) % n_pes()});
  }
  void worst(Callback<double> target) { contribute(max, error_, std::move(target)); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, load, error_);
  }

 private:
  MeshPart part_;
  double error_ = 0;
};

/// `n` steps of the coupling to time 1.
Task subcycle(TimeMethod method, int n, double& error) {
  ArrayProxy<Flow> flow;
  ArrayProxy<Shell> shell;
  const auto flow_parts = mesh_parts(kuhn_mesh({2}), 3, PartitionMethod::curve);
  const auto shell_parts = mesh_parts(kuhn_mesh({3, 0.1}), 4, PartitionMethod::curve);
  co_await epoch([&] {
    flow = create<Flow>(range(3));
    shell = create<Shell>(range(4));
    for (std::int32_t k = 0; k < 3; ++k) flow[{k}].send<&Flow::load>(flow_parts[std::size_t(k)]);
    for (std::int32_t k = 0; k < 4; ++k)
      shell[{k}].send<&Shell::begin>(shell_parts[std::size_t(k)], method);
  });
  const double h = 1.0 / n;
  Coupling to_shell(flow, shell);
  co_await to_shell.search();
  for (int step = -1; step < n; ++step) {
    for (int half = 1; half <= 2; ++half) {  // the source makes two steps, the target five
      const double time = h * (step + 0.5 * half);
      co_await tess::epoch([&] { flow.broadcast<&Flow::step>(time); });
      if (method == TimeMethod::hermite) co_await to_shell.apply<&Flow::rate, &Shell::rates>();
      co_await to_shell.apply<&Flow::pressure, &Shell::load>(
          [&](tess::m2m::CouplingId) { shell.broadcast<&Shell::accept>(time); });
    }
    if (step < 0) continue;  // the samples before the first step
    co_await tess::epoch([&] {
      for (int fifth = 1; fifth <= 5; ++fifth)
        shell.broadcast<&Shell::step>(h * (step + 0.2 * fifth));
    });
  }
  error = co_await shell.reduce<&Shell::worst>();
}

double error_on_threads(TimeMethod method, int n) {
  double error = 0;
  REQUIRE(tests::run_threads(2, [&] { return subcycle(method, n, error); }).exit_code == 0);
  return error;
}

constexpr std::array methods{TimeMethod::linear, TimeMethod::cubic, TimeMethod::hermite};

/// Samples of a polynomial of degree 3, or of 1 for linear, at times of unequal distances.
double polynomial(TimeMethod method, double t) {
  return method == TimeMethod::linear ? 2 - 3 * t : 1 + t * (2 + t * (-3 + t * 0.5));
}
TimeWindow window_of(TimeMethod method, const std::vector<double>& times) {
  TimeWindow window(1, method);
  for (const double t : times) {
    window.values()[0] = polynomial(method, t);
    for (double& rate : window.rates()) rate = 2 + t * (-6 + t * 1.5);
    window.accept(t);
  }
  return window;
}

}  // namespace

TEST_CASE("a source with two steps and a target with five have the order of the method",
          "[m2m][time]") {
  for (const TimeMethod method : methods) {
    const double coarse = error_on_threads(method, 8), fine = error_on_threads(method, 16);
    INFO("method " << static_cast<int>(method) << ": " << coarse << ", " << fine);
    const double order = std::log2(coarse / fine);
    CHECK(std::abs(order - (method == TimeMethod::linear ? 2 : 4)) < 0.2);
    test::for_seeds(0, test::n_seeds(6), [&](std::uint64_t seed) {
      const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
      double error = 0;
      machine.run([&] { return subcycle(method, 8, error); }).require_success();
      REQUIRE(error == coarse);  // bit for bit
    });
  }
}

TEST_CASE("a window is exact for polynomials of its method, also after it has moved",
          "[m2m][time]") {
  for (const TimeMethod method : methods) {
    const std::vector<double> times{0, 0.25, 1, 1.125, 2, 3.5};
    const TimeWindow window = from_bytes<TimeWindow>(to_bytes(window_of(method, times)));
    CHECK(window.n_samples() == 4);  // older ones were dropped
    CHECK(window.first() == 1);
    for (double t = 1; t <= 3.5; t += 0.03125) {
      INFO("method " << static_cast<int>(method) << " at " << t);
      CHECK(std::abs(window.at(t)[0] - polynomial(method, t)) < 1e-14);
    }
    for (const double t : {1.0, 1.125, 2.0, 3.5})
      CHECK(window.at(t)[0] == polynomial(method, t));  // bit for bit
  }
}

TEST_CASE("a sample of the same time replaces one, and NaN stays in its interval", "[m2m][time]") {
  TimeWindow window(1);
  for (const double t : {0.0, 1.0, 1.0, 2.0}) {
    window.values()[0] += t == 0 ? 5 : 1;
    window.accept(t);
  }
  CHECK(window.n_samples() == 3);
  CHECK(window.at(1)[0] == 7);
  window.values()[0] = std::numeric_limits<double>::quiet_NaN();
  window.accept(2);
  CHECK(window.at(1)[0] == 7);
  CHECK(window.at(0.5)[0] == 6);
  CHECK(std::isnan(window.at(1.5)[0]));
}

TEST_CASE("a time outside of the window is refused with the range", "[m2m][time]") {
  const TimeWindow window = window_of(TimeMethod::cubic, {0, 0.25, 1, 1.5, 2});
  const auto refusal = [&](double t) { return test::message_of([&] { (void)window.at(t); }); };
  CHECK_THAT(refusal(2.25), Contains("at time 2.25") && Contains("from 0.25 to 2:"));
  CHECK_THAT(refusal(0), Contains("keep more than 4 samples"));
  CHECK_THAT(refusal(std::nan("")), Contains("at time nan"));
  CHECK(window.at(2 * (1 + 1e-15)) == window.at(2));  // a sum of steps
  TimeWindow empty(1);
  CHECK_THAT(test::message_of([&] { (void)empty.at(0); }), Contains("without samples"));
  empty.accept(3);
  CHECK(empty.at(3)[0] == 0);
  CHECK_THAT(test::message_of([&] { empty.accept(2); }),
             Contains("at time 2 follows one at time 3"));
  CHECK_THAT(test::message_of([] { (void)TimeWindow(1, TimeMethod::linear, 1); }),
             Contains("keeps 1 samples"));
}
