// Runs a scene from its text, on the machine that an option names; and by a plain loop over all
// particles, without blocks or messages: the oracle.
#pragma once

#include "apps/particles/output/report.hpp"
#include "apps/particles/simulation/observe.hpp"
#include "apps/particles/simulation/simulate.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <memory>
#include <string>

namespace particles {

struct Ran {
  std::shared_ptr<Stage> stage;
  RunResult result;
  std::string table{};  ///< as the program prints it
  [[nodiscard]] const Measured& last() const { return result.rows.back().measured; }
};

inline Scene scene_of(const std::string& text) {
  return parse_scene(text, "scene.json");
}

/// option: "--pes=2", "--sim=pes=4,seed=3".
inline Ran run_scene(Scene scene, const std::string& option, const RunOptions& how = {}) {
  tess::Setup setup = tests::setup_of(option);
  Ran ran{std::make_shared<Stage>(std::move(scene)), {}};
  const auto main = [&]() -> tess::Task {
    co_await simulate(ran.stage, ran.result, how);
    ran.table = table(report(ran.stage->scene, ran.result, how), ran.result);
  };
  REQUIRE(tess::run(setup, main) == 0);
  return ran;
}

/// The last row of a run, computed step by step over all particles; the fields of the stage are
/// built.
inline Measured run_serially(const Stage& stage) {
  const Scene& scene = stage.scene;
  std::vector<tess::dn::Object> objects = stage.objects();
  std::vector<Flock> flocks(stage.species.size());
  for (std::uint64_t id = 0; id < stage.source.size(); ++id) {
    const Start start = stage.source.particle(id);
    flocks[stage.species_of(id, start.mass)].add(id, start.position, start.velocity);
  }
  for (std::int32_t step = 0; step < scene.steps; ++step) {
    for (std::size_t s = 0; s < flocks.size(); ++s)
      make_stepper(for_mass(scene.rules, stage.species[s].mass), scene.dt)
          .run(flocks[s].motion.span(), objects, step * scene.dt, 1);
    tess::dn::advance(objects, scene.dt, 1);
  }
  Measured measured;
  for (std::size_t s = 0; s < flocks.size(); ++s)
    measure(stage, objects, flocks[s], stage.species[s].mass, measured);
  return measured;
}

}  // namespace particles
