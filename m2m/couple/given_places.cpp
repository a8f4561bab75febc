#include "m2m/couple/given_places.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace tess::m2m {

void GivenPlaces::add_source(collide::OwnerId piece, std::vector<std::uint32_t> places) {
  if (!places.empty()) sources_[piece].places = std::move(places);
}

Addressed<std::vector<std::uint32_t>> GivenPlaces::keep_rows() {
  std::unordered_map<std::uint32_t, std::uint32_t> n_sources;
  for (const auto& [piece, source] : sources_)
    for (const std::uint32_t place : source.places) ++n_sources[place];
  Addressed<std::vector<std::uint32_t>> out;
  for (auto& [piece, source] : sources_) {
    std::vector<std::uint32_t> kept;
    const std::vector<std::uint32_t> all = std::exchange(source.places, {});
    for (std::size_t row = 0; row < all.size(); ++row) {
      const bool is_shared = n_sources[all[row]] > 1;
      (is_shared ? source.shared : source.places).push_back(all[row]);
      if (!is_shared) kept.push_back(static_cast<std::uint32_t>(row));
    }
    out.emplace_back(piece, std::move(kept));
  }
  return out;
}

void GivenPlaces::join(std::vector<std::pair<collide::OwnerId, PartialRows>> partial) {
  struct SharedWeight {
    std::uint32_t place;
    GlobalId id;
    VertexId value;  // among those of all sources
    double weight;
  };
  std::vector<SharedWeight> entries;
  std::sort(partial.begin(), partial.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [piece, rows] : partial) {
    Source& source = sources_.at(piece);
    source.first_value = n_values_;
    source.n_values = static_cast<std::uint32_t>(rows.ids.size());
    for (std::size_t row = 0; row < source.shared.size(); ++row)
      for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k)
        entries.push_back({source.shared[row], rows.ids[rows.columns[k]],
                           static_cast<VertexId>(n_values_ + rows.columns[k]), rows.weights[k]});
    source.shared = {};
    n_values_ += source.n_values;
  }
  // By id, as in the rows of one piece; of several copies of an unknown, the first piece's is used.
  std::sort(entries.begin(), entries.end(), [](const SharedWeight& a, const SharedWeight& b) {
    return std::tie(a.place, a.id, a.value) < std::tie(b.place, b.id, b.value);
  });
  for (auto entry = entries.begin(); entry != entries.end();) {
    const std::uint32_t place = entry->place;
    while (entry != entries.end() && entry->place == place) {
      const SharedWeight& first = *entry;
      double weight = 0;
      for (; entry != entries.end() && entry->place == place && entry->id == first.id; ++entry)
        weight += entry->weight;
      shared_rows_.add(first.value, weight);
    }
    shared_rows_.end_row();
    shared_places_.push_back(place);
  }
}

Addressed<std::vector<VertexId>> GivenPlaces::keep_weights(std::span<const PlaceWeight> weights) {
  // Per source piece and point: whether its value is needed, then its position among all values.
  std::map<collide::OwnerId, std::vector<std::uint32_t>> numbers;
  for (const PlaceWeight& w : weights) {
    std::vector<std::uint32_t>& needed = numbers[w.source];
    const auto vertex = static_cast<std::size_t>(w.vertex);
    if (needed.size() <= vertex) needed.resize(std::max(vertex + 1, 2 * needed.size()), 0);
    needed[vertex] = 1;
  }
  Addressed<std::vector<VertexId>> out;
  for (auto& [piece, number] : numbers) {
    std::vector<VertexId> sent;
    Source& source = sources_[piece];
    source.first_value = n_values_;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == 0) continue;
      number[v] = n_values_++;
      sent.push_back(static_cast<VertexId>(v));
    }
    source.n_values = static_cast<std::uint32_t>(sent.size());
    source.sent = sent;
    out.emplace_back(piece, std::move(sent));
  }
  for (auto w = weights.begin(); w != weights.end();) {
    shared_places_.push_back(w->place);
    for (; w != weights.end() && w->place == shared_places_.back(); ++w)
      shared_rows_.add(
          static_cast<VertexId>(numbers[w->source][static_cast<std::size_t>(w->vertex)]),
          w->weight);
    shared_rows_.end_row();
  }
  return out;
}

std::vector<PlaceWeight> GivenPlaces::weights() const {
  std::vector<std::pair<collide::OwnerId, VertexId>> values;  // in the order of their numbers
  for (const auto& [piece, source] : sources_)
    for (const VertexId vertex : source.sent) values.emplace_back(piece, vertex);
  std::vector<PlaceWeight> out;
  for (std::size_t row = 0; row < shared_rows_.n_rows(); ++row)
    for (std::uint64_t k = shared_rows_.begin[row]; k < shared_rows_.begin[row + 1]; ++k) {
      const auto& [piece, vertex] = values[static_cast<std::size_t>(shared_rows_.columns[k])];
      out.push_back({shared_places_[row], vertex, piece, shared_rows_.weights[k]});
    }
  return out;
}

GivenPlaces::Sums GivenPlaces::add_up(const std::vector<GivenValues>& messages,
                                      std::size_t n_places, bool with_ranges) const {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Sums out;
  std::vector<double> values;
  for (const GivenValues& message : messages) {
    const Source& source = sources_.at(message.from);
    const std::size_t n =
        message.values.size() / ((with_ranges ? 3 : 1) * source.places.size() + source.n_values);
    TESS_CHECK(out.n_components == 0 || n == out.n_components, "source pieces give ",
               out.n_components, " and ", n, " components in one round: give equally many");
    if (out.n_components == 0) {
      out.n_components = n;
      out.values.assign(n_places * n, 0);
      if (with_ranges) out.ranges.assign(n_places * n, {inf, -inf});
      values.resize(n_values_ * n);
    }
    const double* from = message.values.data();
    for (const std::uint32_t place : source.places)
      for (std::size_t c = 0; c < n; ++c) out.values[place * n + c] = *from++;
    if (with_ranges)
      for (const std::uint32_t place : source.places)
        for (std::size_t c = 0; c < n; ++c, from += 2)
          out.ranges[place * n + c] = {from[0], from[1]};
    std::copy_n(from, source.n_values * n, values.data() + source.first_value * n);
  }
  const std::size_t n = out.n_components;
  std::vector<double> sums(shared_places_.size() * n);
  m2m::apply(shared_rows_, values, n, sums);
  std::vector<ValueRange> ranges(with_ranges ? sums.size() : 0);
  if (with_ranges) value_ranges(shared_rows_, values, n, ranges);
  for (std::size_t k = 0; k < shared_places_.size(); ++k)
    for (std::size_t c = 0; c < n; ++c) {
      out.values[shared_places_[k] * n + c] = sums[k * n + c];
      if (with_ranges) out.ranges[shared_places_[k] * n + c] = ranges[k * n + c];
    }
  return out;
}

}  // namespace tess::m2m
