#include "collide/search/thin_pairs.hpp"

#include "collide/problem/piece_pairs.hpp"
#include "collide/problem/survey.hpp"
#include "collide/search/choose_pieces.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace tess::collide::search {
namespace {

/// Throws Error if a box is not valid.
template <class Real>
Frame checked_frame(ThinSets<Real> sets) {
  Box<Real, 3> bounds =
      checked_bounds(sets.front().boxes, sets.size() == 1 ? "" : " of the first set");
  if (sets.size() == 2)
    bounds = merged(bounds, checked_bounds(sets[1].boxes, " of the second set"));
  return frame_of(in_double(bounds));
}

/// A search that is under way: passes on what is left of the pairs of boxes.
template <class Real>
struct Receiver {
  using Pairs = PiecePairs<ThinObjects<Real>>;

  const ThinObjects<Real>&a, &b;
  const Touching touching;
  const detail::PairSink sink;
  Pairs pairs{};

  static void call(void* context, const std::uint32_t* objects, const std::uint32_t* partners,
                   std::size_t n, bool swapped) {
    auto& self = *static_cast<Receiver*>(context);
    for (std::size_t begin = 0; begin < n; begin += Pairs::most)
      self.pass_on(objects + begin, partners + begin, std::min(n - begin, Pairs::most), swapped);
  }
  void pass_on(const std::uint32_t* pieces, const std::uint32_t* partners, std::size_t n,
               bool swapped) {
    const ThinObjects<Real>&x = swapped ? b : a, &y = swapped ? a : b;
    pairs.find(x, pieces, y, partners, n, touching);
    std::array<std::uint32_t, Pairs::most> of_x, of_y;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      of_x[p] = x.object_of(pairs.x()[p]);
      of_y[p] = y.object_of(pairs.y()[p]);
    }
    if (pairs.size() != 0) sink.call(sink.context, of_x.data(), of_y.data(), pairs.size(), swapped);
  }
};

}  // namespace

template <class Real>
void search_thin(ThinSets<Real> sets, double longest, const PairOptions& options,
                 detail::PairSink sink) {
  const Frame frame = checked_frame(sets);
  const ThinObjects<Real> a(sets.front(), frame, longest, 0);
  std::optional<ThinObjects<Real>> second;
  if (sets.size() == 2) second.emplace(sets.back(), frame, longest, std::uint64_t{1} << 32);
  const ThinObjects<Real>& b = second ? *second : a;

  Receiver<Real> receiver{a, b, options.touching, sink};
  PairOptions of_pieces = options;
  std::vector<std::uint32_t> models;
  if (a.in_pieces()) {
    of_pieces.touching = Touching::counts;
    if (divides(options))
      for (std::uint32_t i = 0; i < a.boxes().size(); ++i)
        models.push_back(options.models[a.object_of(i)]);
    of_pieces.models = models;
  }
  const std::array<ThinSet<Real>, 2> boxes{{{a.boxes()}, {b.boxes()}}};
  detail::search_pairs(ThinSets<Real>(boxes).first(sets.size()), of_pieces,
                       {&receiver, &Receiver<Real>::call});
  if (options.statistics == nullptr) return;
  options.statistics->n_candidates -= receiver.pairs.n_own();
  options.statistics->bytes += a.bytes() + (second ? b.bytes() : 0) + models.capacity() * 4;
}

template void search_thin(ThinSets<float>, double, const PairOptions&, detail::PairSink);
template void search_thin(ThinSets<double>, double, const PairOptions&, detail::PairSink);

}  // namespace tess::collide::search
