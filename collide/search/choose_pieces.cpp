#include "collide/search/choose_pieces.hpp"

#include "collide/problem/choose_grid.hpp"
#include "collide/problem/costs.hpp"
#include "collide/problem/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tess::collide::search {
namespace {

/// About 2 sqrt(n) of n objects: among them are four times as many pairs as each object has in the
/// whole set.
template <class Real>
struct Sample {
  Sample(const ThinSet<Real>& set, double scale) {
    const std::size_t n = set.boxes.size();
    const double n_meant = scale * static_cast<double>(n);
    const auto wanted = static_cast<std::size_t>(std::ceil(2 * std::sqrt(n_meant)));
    const std::size_t n_samples = std::min(n, wanted);
    for (std::size_t i = 0; i < n_samples; ++i) {
      const std::size_t at = scattered(i, n_samples, n);
      objects.push_back(static_cast<std::uint32_t>(at));
      boxes.push_back(set.boxes[at]);
      capsules.push_back(set.capsules[at]);
      bounds = merged(bounds, boxes.back());
      are_valid = are_valid && is_valid(boxes.back());
    }
    share = static_cast<double>(n_samples) / n_meant;
  }

  std::vector<std::uint32_t> objects;
  std::vector<Box<Real, 3>> boxes;
  std::vector<Capsule> capsules;
  Box<Real, 3> bounds = no_box<Real, 3>();
  bool are_valid = true;
  double share;

  [[nodiscard]] std::vector<SlimCapsule> slims(const Frame& frame) const {
    std::vector<SlimCapsule> out;
    for (const Capsule& capsule : capsules) out.push_back(slim(capsule, frame));
    return out;
  }
};

/// Positions in two samples of pairs whose boxes overlap.
struct SampledPairs {
  std::vector<std::uint32_t> in_a, in_b;

  static void call(void* context, const std::uint32_t* objects, const std::uint32_t* partners,
                   std::size_t n, bool swapped) {
    auto& self = *static_cast<SampledPairs*>(context);
    self.in_a.insert(self.in_a.end(), swapped ? partners : objects,
                     (swapped ? partners : objects) + n);
    self.in_b.insert(self.in_b.end(), swapped ? objects : partners,
                     (swapped ? objects : partners) + n);
  }
};

/// How many pairs of pieces of two objects overlap, and how many there are.
struct Overlaps {
  double n = 0, of = 0;
};
template <class Real>
Overlaps overlaps(const Sample<Real>& a, std::uint32_t i, const Sample<Real>& b, std::uint32_t j,
                  double longest) {
  BoxesOfPieces<Real> of_a, of_b;
  const auto* const end_a =
      cut(a.boxes[i], a.capsules[i], n_pieces(a.capsules[i], longest), of_a.data());
  const auto* const end_b =
      cut(b.boxes[j], b.capsules[j], n_pieces(b.capsules[j], longest), of_b.data());
  Overlaps out;
  for (const auto* p = of_a.data(); p != end_a; ++p)
    for (const auto* q = of_b.data(); q != end_b; ++q)
      if (overlap(*p, *q, Touching::counts)) ++out.n;
  out.of = static_cast<double>((end_a - of_a.data()) * (end_b - of_b.data()));
  return out;
}

}  // namespace

template <class Real>
std::optional<double> choose_pieces(ThinSets<Real> sets, const PairOptions& options, double scale) {
  for (const auto& set : sets)
    if (!detail::seem_thin(set.capsules, set.boxes.size())) return {};
  const bool by_model = divides(options);
  // What is no valid search is refused by the search without capsules.
  if (by_model && (sets.size() == 2 || options.models.size() != sets.front().boxes.size()))
    return {};
  const Sample<Real> a(sets.front(), scale), b(sets.back(), scale);
  if (!a.are_valid || !b.are_valid) return {};
  SampledPairs sampled;
  const detail::PairSink sink{&sampled, &SampledPairs::call};
  const std::array<ThinSet<Real>, 2> samples{{{a.boxes}, {b.boxes}}};
  std::vector<std::uint32_t> models;
  if (by_model)
    for (const std::uint32_t object : a.objects) models.push_back(options.models[object]);
  const PairOptions of_sample{.touching = options.touching,
                              .models = models,
                              .within_model = by_model ? WithinModel::skip : WithinModel::test};
  detail::search_pairs(ThinSets<Real>(samples).first(sets.size()), of_sample, sink);
  const auto& [in_a, in_b] = sampled;
  constexpr std::size_t few = 16, most_measured = 32;
  if (in_a.size() < few) return {};
  const auto n_sampled = static_cast<double>(in_a.size());
  std::vector<std::uint32_t> kept(in_a.size() + 8);
  const Frame frame = frame_of(in_double(merged(a.bounds, b.bounds)));
  const auto kept_share =
      static_cast<double>(may_meet(a.slims(frame).data(), b.slims(frame).data(), in_a.data(),
                                   in_b.data(), in_a.size(), kept.data())) /
      n_sampled;
  const double n_pairs = n_sampled / (a.share * b.share);
  double n_objects = 0;
  for (const auto& set : sets) n_objects += scale * static_cast<double>(set.boxes.size());

  std::optional<double> best;
  double least = n_pairs * (costs::per_pair + costs::per_test);
  const auto look_at = [&](double longest, double n_of_pieces, double n_overlapping) {
    const double cost =
        n_objects * costs::per_capsule + n_of_pieces * costs::per_piece +
        n_overlapping * (costs::per_pair + costs::per_capsules + kept_share * costs::per_test);
    if (cost >= least) return;
    least = cost;
    best = longest;
  };
  look_at(ThinObjects<Real>::whole, 0, n_pairs);
  // Pieces have voxels that are chosen for them.
  if (options.voxel_size > 0) return best;
  double longest = 0;
  for (const Sample<Real>* sample : {&a, &b})
    for (const Box<Real, 3>& box : sample->boxes)
      longest = std::max(longest, static_cast<double>(longest_extent(box)));
  const std::size_t n_measured = std::min(in_a.size(), most_measured);
  double n_compared = 0;
  // The choice itself takes a small part of what it may spare.
  for (longest /= 2;
       longest > 0 && std::isfinite(longest) && 16 * n_compared * costs::per_overlap < least;
       longest /= 2) {
    double n_of_pieces = 0;
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const Sample<Real>& sample = s == 0 ? a : b;
      for (const Capsule& capsule : sample.capsules)
        n_of_pieces += n_pieces(capsule, longest) / sample.share;
    }
    if (n_of_pieces * costs::per_piece > least ||
        n_of_pieces > 0.5 * static_cast<double>(most_objects))
      break;
    double n_overlapping = 0;
    for (std::size_t m = 0; m < n_measured; ++m) {
      const std::size_t at = scattered(m, n_measured, in_a.size());
      const Overlaps found = overlaps(a, in_a[at], b, in_b[at], longest);
      n_overlapping += found.n;
      n_compared += found.of;
    }
    look_at(longest, n_of_pieces, n_pairs * n_overlapping / static_cast<double>(n_measured));
  }
  return best;
}

template std::optional<double> choose_pieces(ThinSets<float>, const PairOptions&, double);
template std::optional<double> choose_pieces(ThinSets<double>, const PairOptions&, double);

}  // namespace tess::collide::search

bool tess::collide::detail::seem_thin(const Capsules& capsules, std::size_t n) {
  const std::size_t n_samples = std::min<std::size_t>(n, 64);
  std::size_t n_thin = 0;
  for (std::size_t i = 0; i < n_samples; ++i) {
    const Capsule capsule = capsules[search::scattered(i, n_samples, n)];
    if (16 * capsule.radius < search::longest_extent(capsule)) ++n_thin;
  }
  return 2 * n_thin > n_samples;
}
