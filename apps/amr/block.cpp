#include "apps/amr/block.hpp"

#include "apps/kit/charge.hpp"
#include "runtime/more/monitor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace amr {
namespace {

constexpr std::chrono::nanoseconds per_cell{10};  // and sweep, as measured

}  // namespace

void Block::begin(Birth birth) {
  if (problem_.n_steps == 0) {  // the first message
    problem_ = birth.problem;
    patch_ = Patch(problem_, index());
    around_ = Neighbourhood(index());
  }
  if (birth.octant < 0) {
    around_.set_sides(birth.sides);
    patch_.take(std::move(birth.masses));
  } else {  // one of eight children that merge here
    around_.take_sides(birth.octant, birth.sides);
    patch_.take(birth.octant, birth.masses);
  }
}

tess::Task Block::advance(std::int32_t first, std::int32_t n) {
  for (std::int32_t sweep = 3 * first; sweep < 3 * (first + n); ++sweep) {
    const std::int32_t axis = sweep % 3;
    const std::array<Face, 2> faces{2 * axis, 2 * axis + 1};
    std::int32_t n_halos = 0, n_flows = 0;
    for (const Face face : faces) {
      send_halos(sweep, face);
      n_halos += around_.side(face) > 0 ? n_quadrants : 1;
      n_flows += around_.side(face) > 0 ? n_quadrants : 0;
    }
    for (; n_halos > 0; --n_halos) {
      const Halo halo = co_await halos_.take(sweep);
      if (around_.side(halo.face) > 0)
        patch_.set_halo(halo.face, halo.quadrant, halo.values);
      else
        patch_.set_halo(halo.face, halo.values);
    }
    patch_.compute_flows(axis);
    kit::charge(per_cell, static_cast<std::size_t>(problem_.cells_per_block()));
    for (const Face face : faces)
      if (around_.side(face) < 0) send_flows(sweep, face);
    for (; n_flows > 0; --n_flows) {
      const Flows flows = co_await flows_.take(sweep);
      if (problem_.corrected) patch_.set_flows(flows.face, flows.quadrant, flows.values);
    }
    patch_.apply_flows(axis);
  }
  draw((first + n) * problem_.dt);
}

void Block::draw(double time) const {
  const std::int32_t side = std::min(problem_.n_cells << problem_.most_level, 1024);
  const std::int32_t n = side >> index().level();
  const double z = problem_.centre[2] + problem_.velocity[2] * time;
  const auto low = patch_.low();
  const double at = (z - std::floor(z) - low[2]) * (1 << index().level());  // 0 … 1: within it
  if (n == 0 || at < 0 || at >= 1) return;
  tess::show("u in the plane through the centre", [&] {
    const auto pixel = [&](double x) { return static_cast<std::int32_t>(std::lround(x * side)); };
    return tess::Picture{side, side, pixel(low[0]), pixel(low[1]), n, patch_.slice(at, n)};
  });
}

void Block::send_halos(std::int32_t sweep, Face face) const {
  std::int32_t n = 0;
  for (const auto& [to, quadrant] : around_.behind(face))
    array()[to].send<&Block::receive_halo>(Halo{sweep, face ^ 1, quadrant,
                                                around_.side(face) < 0 ? patch_.coarse_layers(face)
                                                : around_.side(face) > 0
                                                    ? patch_.fine_layers(face, n++)
                                                    : patch_.layers(face)});
}

void Block::send_flows(std::int32_t sweep, Face face) const {
  for (const auto& [to, quadrant] : around_.behind(face))
    array()[to].send<&Block::receive_flows>(
        Flows{sweep, face ^ 1, quadrant, patch_.coarse_flows(face)});
}

void Block::plan() {
  if (around_.has_chosen()) return;  // by the message of a neighbour
  around_.choose(patch_.steepness(), problem_);
  tell();
}

void Block::hear(const Choice& of_neighbour) {
  plan();
  if (around_.hear(of_neighbour)) tell();
}

void Block::tell() const {
  for (Face face = 0; face < n_faces; ++face)
    for (const auto& [to, quadrant] : around_.behind(face))
      array()[to].send<&Block::hear>(Choice{face ^ 1, quadrant, around_.choice()});
}

void Block::change() {
  if (!around_.has_chosen()) return;  // created by this change
  if (around_.choice() > index().level())
    split();
  else if (around_.choice() < index().level())
    merge();
  else
    around_.stay();
}

void Block::split() {
  for (std::int32_t octant = 0; octant < n_octants; ++octant)
    array()[index().child(octant)].send_or_create_home<&Block::begin>(
        Birth{problem_, -1, around_.next_sides(octant), patch_.refined(octant)});
  destroy();
}

void Block::merge() {
  const std::int32_t octant = index().octant();
  array()[index().parent()].send_or_create_home<&Block::begin>(
      Birth{problem_, octant, around_.next_sides(octant), patch_.coarsened()});
  destroy();
}

void Block::count(double time, const tess::Callback<Census>& result) {
  Census own{.norms = patch_.compare(time), .n_blocks = 1, .n_new = is_new_ ? 1 : 0};
  own.of_level.at(static_cast<std::size_t>(index().level())) = 1;
  is_new_ = false;
  contribute(tess::sum, own, result);
}

}  // namespace amr
