// The loops of the library once more, under another name and compiled for the oldest x86-64: no
// AVX, no gathers, no fused operations.
#define lanes plain_lanes
#define simd plain_simd

#include "tests/collide/dn_field/plain_lanes.hpp"

#ifdef __AVX__
#error "this source is to be compiled without vector gathers"
#endif

namespace tess::dn::plain {

void loop(const RuleConstants& c, const ParticleSpan& particles, const NearestSurface& nearest,
          Scratch& scratch) {
  lanes::flow_loop<Setting::general>(c.flow, particles, nearest);
  lanes::rule_loop<Flight{true, Drags::surface}, Impacts::swept, Springs::exact, Setting::general>(
      c, particles, nearest, scratch);
}

template <LookUp Kind>
void sample_all(const Field& field, const float* points, float* out) {
  const Sampler sampler = sampler_of(field);
  for (int i = 0; i < sample_count; i += lanes::width) {
    const Sample found = lanes::sample<Kind, Ask::both>(
        sampler,
        {lanes::load<lanes::F>(points + i), lanes::load<lanes::F>(points + sample_count + i),
         lanes::load<lanes::F>(points + 2 * sample_count + i)});
    lanes::store(out + i, found.distance_or_far());
    lanes::store(out + sample_count + i, found.normal.x);
    lanes::store(out + 2 * sample_count + i, found.normal.y);
    lanes::store(out + 3 * sample_count + i, found.normal.z);
  }
}

void samples(const Field& field, LookUp kind, const float* points, float* out) {
  if (kind == LookUp::nearest) sample_all<LookUp::nearest>(field, points, out);
  if (kind == LookUp::tangent) sample_all<LookUp::tangent>(field, points, out);
  if (kind == LookUp::trilinear) sample_all<LookUp::trilinear>(field, points, out);
}

}  // namespace tess::dn::plain
