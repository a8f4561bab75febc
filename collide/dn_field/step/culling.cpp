#include "collide/dn_field/step/culling.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr float rounding = 1.0001F;  // of float speeds

/// A lower bound of all sampled distances, minus the reach of the rules and the way of the surface:
/// the minimum over objects.
template <bool Turned, bool Moves, bool First, bool Compressed>
void room_to(const PlacedObject& placed, F taken, Reach reach, const ParticleSpan& span,
             NearParticles& near) {
  const PlacedObject object = placed;  // copies that no store can change
  const ParticleSpan block = span;
  const Sampler& field = object.field;
  const Vec3 c = object.centre;
  const auto& m = object.to_grid;
  const F ox = all(object.middle[0] + 0.5F), oy = all(object.middle[1] + 0.5F),
          oz = all(object.middle[2] + 0.5F);
  const auto nx = static_cast<float>(field.n[0]), ny = static_cast<float>(field.n[1]),
             nz = static_cast<float>(field.n[2]);
  const F speed = all(static_cast<float>(norm(object.frame.velocity) + object.swell)),
          spin = all(static_cast<float>(norm(object.frame.angular_velocity)));
  const F shift = all(static_cast<float>(norm(c - object.frame.position)));
  const F time = all(reach.time * rounding);
  // A displacement of one cell may lead two voxels on.
  const F share = all(reach.ahead ? 1 / (1 + object.jump / object.cell) : 1.0F);
  for (std::size_t p = 0; p < block.count; p += width) {
    const F3 q = to_float(places(block, p) - c);
    F3 h;
    if constexpr (Turned)
      h = {q.x * m[0][0] + q.y * m[0][1] + q.z * m[0][2] + ox,
           q.x * m[1][0] + q.y * m[1][1] + q.z * m[1][2] + oy,
           q.x * m[2][0] + q.y * m[2][1] + q.z * m[2][2] + oz};
    else
      h = {q.x * m[0][0] + ox, q.y * m[1][1] + oy, q.z * m[2][2] + oz};
    const Voxel voxel = voxel_from_corner(field.n, h);
    F found;
    if constexpr (Compressed)
      found = planes_at(object.planes, voxel).distance;
    else
      found = gather(field.distance, position(field, voxel));
    const F beyond = max(max(max(-h.x, h.x - nx), max(-h.y, h.y - ny)), max(-h.z, h.z - nz));
    F room = voxel.in ? (found * object.scale - taken) * share
                      : object.cell * (0.999F * beyond - 1.0F) - reach.distance;
    if constexpr (Moves) {
      // Relative to the surface, a particle at distance r from the object's origin moves at most
      // (v + speed)(1 + spin time) + spin r per unit time.
      const F turned = spin * time * (sqrt(dot(q, q)) + shift);
      room = (room - turned) / (1.0F + spin * time) - time * speed;
    }
    if constexpr (!First) room = min(room, load<F>(near.room + p));
    store(near.room + p, room);
  }
}

using RoomTo = void (*)(const PlacedObject&, F, Reach, const ParticleSpan&, NearParticles&);

RoomTo room_loop(const PlacedObject& object, bool is_first) {
  const bool moves = object.frame.is_moving(), turned = moves || object.frame.is_turned();
  return with<false, true>(turned, [=, &object]<bool Turned> {
    return with<false, true>(moves, [=, &object]<bool Moves> {
      return with<false, true>(is_first, [=, &object]<bool First> {
        return with<false, true>(object.compressed, []<bool Compressed>() -> RoomTo {
          return &room_to<Turned, Moves, First, Compressed>;
        });
      });
    });
  });
}

}  // namespace

void cull(std::span<const PlacedObject> objects, LookUp kind, Sweep sweep, Reach reach,
          const ParticleSpan& block, NearParticles& near) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const PlacedObject& object = objects[i];
    // Nearest is this voxel's value; the tangent differs from it by at most half a diagonal, and
    // trilinear blends it with adjacent voxels. A sweep adds half a diagonal to any of them.
    const bool half_off = kind == LookUp::tangent || sweep == Sweep::on;
    const float jumps = (kind == LookUp::trilinear ? 1.0F : 0.0F) + (reach.ahead ? 1.0F : 0.0F);
    const float doubt = (half_off ? object.doubt : 0.0F) + object.padding +
                        (jumps > 0 ? jumps * object.jump : 0.0F);
    room_loop(object, i == 0)(object, all(doubt * rounding + reach.distance), reach, block, near);
  }
  near.count = 0;
  if (objects.empty()) return;
  const F time = all(reach.time * rounding), gain = all(reach.gain);
  // Particles that are near only if a later voxel says so come last: whole vectors of them have
  // nothing to do.
  const F at_once =
      all(reach.ahead ? -objects[0].jump / (1 + objects[0].jump / objects[0].cell) : 0.0F);
  std::array<std::uint32_t, block_size> later;
  std::size_t n_later = 0;
  for (std::size_t p = 0; p < block.count; p += width) {
    const F3 v = to_float(velocities(block, p));
    const F room = load<F>(near.room + p), way = time * (sqrt(dot(v, v)) + gain);
    const unsigned may = bits(~(room >= way)), may_later = may & bits(room - at_once >= way);
    const auto list = [p](unsigned lanes, std::uint32_t* to, std::size_t& count) {
      for (; lanes != 0; lanes &= lanes - 1)
        to[count++] =
            static_cast<std::uint32_t>(p) + static_cast<std::uint32_t>(std::countr_zero(lanes));
    };
    list(may & ~may_later, near.index, near.count);
    list(may_later, later.data(), n_later);
  }
  std::copy_n(later.data(), n_later, near.index + near.count);
  near.count += n_later;
}

ParticleSpan NearParticles::pack(const ParticleSpan& block) {
  const std::size_t whole = (count + width - 1) / width * width;
  for (std::size_t a = 0; a < 6; ++a) {
    const double* const from = block.columns()[a];
    double* const to = packed.values[a];
    for (std::size_t i = 0; i < count; ++i) to[i] = from[index[i]];
    std::fill(to + count, to + whole, 0);
  }
  return packed.span(whole);
}

void NearParticles::unpack(const ParticleSpan& block) const {
  for (std::size_t a = 0; a < 6; ++a) {
    double* const to = block.columns()[a];
    for (std::size_t i = 0; i < count; ++i) to[index[i]] = packed.values[a][i];
  }
}

}  // namespace tess::dn
