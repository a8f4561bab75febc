#include "collide/search/thin_pairs.hpp"

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
class ThinPairs {
 public:
  ThinPairs(const ThinObjects<Real>& a, const ThinObjects<Real>& b, Touching touching,
            detail::PairSink sink)
      : a_(a), b_(b), touching_(touching), sink_(sink) {}

  static void call(void* context, const std::uint32_t* objects, const std::uint32_t* partners,
                   std::size_t n, bool swapped) {
    auto& self = *static_cast<ThinPairs*>(context);
    for (std::size_t begin = 0; begin < n; begin += most)
      self.pass_on(objects + begin, partners + begin, std::min(n - begin, most), swapped);
  }
  /// Pairs of pieces of one object.
  [[nodiscard]] std::uint64_t n_own() const noexcept { return n_own_; }

 private:
  static constexpr std::size_t most = 512;
  using Numbers = std::array<std::uint32_t, most + 8>;

  void pass_on(const std::uint32_t* objects, const std::uint32_t* partners, std::size_t n,
               bool swapped) {
    const ThinObjects<Real>&x = swapped ? b_ : a_, &y = swapped ? a_ : b_;
    Numbers pieces_x, pieces_y, of_x, of_y, kept;
    const std::uint32_t *piece_x = objects, *piece_y = partners, *object_x = objects,
                        *object_y = partners;
    if (a_.in_pieces()) {
      std::size_t n_others = 0;
      for (std::size_t m = 0; m < n; ++m) {
        pieces_x[n_others] = objects[m];
        pieces_y[n_others] = partners[m];
        of_x[n_others] = x.owner(objects[m]);
        of_y[n_others] = y.owner(partners[m]);
        n_others += is_one_set() && of_x[n_others] == of_y[n_others] ? 0U : 1U;
      }
      n_own_ += n - n_others;
      n = n_others;
      piece_x = pieces_x.data();
      piece_y = pieces_y.data();
      object_x = of_x.data();
      object_y = of_y.data();
    }
    const std::size_t n_kept =
        may_meet(x.capsules(), y.capsules(), object_x, object_y, n, kept.data());
    Numbers out_x, out_y;
    std::size_t n_out = 0;
    for (std::size_t k = 0; k < n_kept; ++k) {
      const std::uint32_t m = kept[k];
      if (a_.in_pieces() &&
          !counts(x, piece_x[m], object_x[m], y, piece_y[m], object_y[m], swapped))
        continue;
      out_x[n_out] = object_x[m];
      out_y[n_out++] = object_y[m];
    }
    if (n_out != 0) sink_.call(sink_.context, out_x.data(), out_y.data(), n_out, swapped);
  }
  [[nodiscard]] bool is_one_set() const noexcept { return &a_ == &b_; }

  /// Whether these pieces, whose boxes overlap, are the first ones of their objects that do. Pieces
  /// touch where the objects may overlap, so touching boxes of pieces are pairs.
  [[nodiscard]] bool counts(const ThinObjects<Real>& x, std::uint32_t p, std::uint32_t i,
                            const ThinObjects<Real>& y, std::uint32_t q, std::uint32_t j,
                            bool swapped) const noexcept {
    if (!overlap(x.boxes_of_objects()[i], y.boxes_of_objects()[j], touching_)) return false;
    return (is_one_set() ? i > j : swapped) ? is_first(y, q, j, x, p, i)
                                            : is_first(x, p, i, y, q, j);
  }
  [[nodiscard]] static bool is_first(const ThinObjects<Real>& x, std::uint32_t p, std::uint32_t i,
                                     const ThinObjects<Real>& y, std::uint32_t q,
                                     std::uint32_t j) noexcept {
    return are_first(x.pieces(i), p - x.begin(i), y.pieces(j), q - y.begin(j),
                     y.boxes_of_objects()[j]);
  }

  const ThinObjects<Real>&a_, &b_;
  const Touching touching_;
  const detail::PairSink sink_;
  std::uint64_t n_own_ = 0;
};

}  // namespace

template <class Real>
void search_thin(ThinSets<Real> sets, double longest, const PairOptions& options,
                 detail::PairSink sink) {
  const Frame frame = checked_frame(sets);
  const ThinObjects<Real> a(sets.front(), frame, longest);
  std::optional<ThinObjects<Real>> second;
  if (sets.size() == 2) second.emplace(sets.back(), frame, longest);
  const ThinObjects<Real>& b = second ? *second : a;

  ThinPairs<Real> pairs(a, b, options.touching, sink);
  const detail::PairSink inner{&pairs, &ThinPairs<Real>::call};
  PairOptions of_pieces = options;
  std::vector<std::uint32_t> models;
  if (a.in_pieces()) {
    of_pieces.touching = Touching::counts;
    if (divides(options))
      for (std::uint32_t i = 0; i < a.boxes().size(); ++i)
        models.push_back(options.models[a.owner(i)]);
    of_pieces.models = models;
  }
  if (sets.size() == 2)
    detail::search_pairs(a.boxes(), b.boxes(), of_pieces, inner);
  else
    detail::search_pairs(a.boxes(), of_pieces, inner);
  if (options.statistics == nullptr) return;
  options.statistics->n_candidates -= pairs.n_own();
  options.statistics->bytes += a.bytes() + (second ? b.bytes() : 0) + models.capacity() * 4;
}

template void search_thin(ThinSets<float>, double, const PairOptions&, detail::PairSink);
template void search_thin(ThinSets<double>, double, const PairOptions&, detail::PairSink);

}  // namespace tess::collide::search

namespace tess::collide::detail {

template <class Real>
void search_pairs(std::span<const Box<Real, 3>> boxes, const Capsules& capsules,
                  const PairOptions& options, PairSink sink) {
  if (options.invalid_boxes == InvalidBoxes::leave_out) return search_pairs(boxes, options, sink);
  const search::ObjectsWithCapsules<Real> set{boxes, capsules};
  const search::ThinSets<Real> sets(&set, 1);
  const std::optional<double> longest = search::choose_pieces(sets, options);
  if (longest)
    search::search_thin(sets, *longest, options, sink);
  else
    search_pairs(boxes, options, sink);
}

template <class Real>
void search_pairs(std::span<const Box<Real, 3>> a, const Capsules& capsules_a,
                  std::span<const Box<Real, 3>> b, const Capsules& capsules_b,
                  const PairOptions& options, PairSink sink) {
  if (options.invalid_boxes == InvalidBoxes::leave_out) return search_pairs(a, b, options, sink);
  const std::array<search::ObjectsWithCapsules<Real>, 2> both{{{a, capsules_a}, {b, capsules_b}}};
  const search::ThinSets<Real> sets(both);
  const std::optional<double> longest = search::choose_pieces(sets, options);
  if (longest)
    search::search_thin(sets, *longest, options, sink);
  else
    search_pairs(a, b, options, sink);
}

#define TESS_INSTANTIATE(Real)                                                                   \
  template void search_pairs(std::span<const Box<Real, 3>>, const Capsules&, const PairOptions&, \
                             PairSink);                                                          \
  template void search_pairs(std::span<const Box<Real, 3>>, const Capsules&,                     \
                             std::span<const Box<Real, 3>>, const Capsules&, const PairOptions&, \
                             PairSink);
TESS_INSTANTIATE(float)
TESS_INSTANTIATE(double)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::detail
