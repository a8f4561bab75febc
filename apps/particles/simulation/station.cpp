#include "apps/particles/simulation/station.hpp"

#include "apps/particles/simulation/block.hpp"

#include <map>
#include <utility>

namespace particles {
namespace {

/// The PEs of this process: the first and how many.
std::pair<std::int32_t, std::int32_t> pes_of_process() {
  const tess::Machine& machine = tess::machine();
  return {machine.first_pe(machine.process_of(tess::my_pe())).value, machine.pes_per_process()};
}

}  // namespace

void Station::take(StageHandle handle) {
  stage_ = handle.stage;
  const auto [first, n] = pes_of_process();
  if (pe().value != first) return;
  for (std::int32_t i = 1; i < n; ++i) group()[tess::PeId{first + i}].send<&Station::take>(handle);
}

template <class Action>
void Station::make(std::size_t field, const Action& action) {
  const Scene& scene = stage_->scene;
  try {
    action(stage_->fields[field]);
  } catch (const tess::Error& error) {
    tess::fail(error.code(), scene.name, ": objects[", field, "]: ", error.what());
  }
}

template <class Action>
void Station::make_mine(const Action& action) {
  const auto [first, n] = pes_of_process();
  for (auto i = static_cast<std::size_t>(pe().value - first); i < stage_->fields.size();
       i += static_cast<std::size_t>(n))
    make(i, [&, i](FieldInTheMaking& field) { action(field, i); });
}

void Station::begin_fields() {
  const Scene& scene = stage_->scene;
  const std::int32_t n_parts = pes_of_process().second;
  make_mine([&](FieldInTheMaking& field, std::size_t i) {
    const SceneObject& object = scene.objects[i];
    field.begin(object, content_of(scene), n_parts);
    if (object.sides == tess::dn::Sides::two && stage_->n_audited > 0)
      stage_->triangles[i].emplace(object.surface);
  });
}

void Station::fill_fields(std::int32_t stage) {
  const std::int32_t part = pe().value - pes_of_process().first;
  for (std::size_t i = 0; i < stage_->fields.size(); ++i)
    make(i, [&](FieldInTheMaking& field) { field.fill(stage, part); });
}

void Station::finish_fields() {
  make_mine([&](FieldInTheMaking& field, std::size_t) { field.finish(stage_->scene.compression); });
}

void Station::prepare(double block_edge) {
  space_ = Space::around(stage_->source.bounds(), block_edge);
  if (needs_field(stage_->scene.rules)) objects_ = stage_->objects();
  for (const double mass : masses_of(stage_->scene)) {
    const tess::dn::Rules rules = for_mass(stage_->scene.rules, mass);
    try {
      validate(rules, objects_);
    } catch (const tess::Error& error) {
      tess::fail(error.code(), stage_->scene.name, ": objects: ", error.what());
    }
    steppers_.push_back(tess::dn::make_stepper(rules, stage_->scene.dt));
  }
}

void Station::emit(tess::ArrayProxy<Block> blocks) {
  constexpr std::size_t most_a_message = 16384;
  const Stage& stage = *stage_;
  const std::uint64_t n = stage.source.size();
  const auto rank = static_cast<std::uint64_t>(pe().value),
             n_pes = static_cast<std::uint64_t>(tess::n_pes());
  const std::uint64_t begin = n * rank / n_pes, end = n * (rank + 1) / n_pes;
  std::map<tess::Index3, Arrivals> leaving;
  const auto send = [&](tess::Index3 to, Arrivals& arrivals) {
    blocks[to].send_or_create_home<&Block::enter>(std::move(arrivals));
  };
  for (std::uint64_t id = begin; id < end; ++id) {
    const Start start = stage.source.particle(id);
    const tess::Index3 to = space_.block_of(start.position);
    Arrivals& arrivals = leaving[to];
    arrivals.stations = group();
    arrivals.flocks.resize(stage.species.size());
    Flock& flock = arrivals.flocks[stage.species_of(id, start.mass)];
    flock.add(id, start.position, start.velocity);
    if (flock.size() < most_a_message) continue;
    send(to, arrivals);
    leaving.erase(to);
  }
  for (auto& [to, arrivals] : leaving) send(to, arrivals);
}

const std::vector<tess::dn::Object>& Station::objects(std::int32_t step) {
  TESS_CHECK(step >= at_step_, "the objects stand at step ", at_step_, ", not back at ", step);
  if (step > at_step_) tess::dn::advance(objects_, stage_->scene.dt, step - at_step_);
  at_step_ = step;
  return objects_;
}

void Station::give_measured(tess::Callback<Measured> target) {
  contribute(tess::sum, std::exchange(measured_, {}), std::move(target));
}

void Station::give_samples(tess::Callback<std::vector<Sample>> target) {
  contribute(tess::concatenate, std::exchange(samples_, {}), std::move(target));
}

void Station::give_spent(tess::Callback<std::vector<Spent>> target) {
  for (const FieldInTheMaking& field : stage_->fields)
    spent_.build = std::max(spent_.build, field.seconds());
  contribute(tess::concatenate, std::vector{spent_}, std::move(target));
}

}  // namespace particles
