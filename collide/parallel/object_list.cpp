#include "collide/parallel/object_list.hpp"

#include "collide/problem/octaves.hpp"
#include "collide/problem/survey.hpp"
#include "collide/problem/thin_objects.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

namespace tess::collide {
namespace {

[[noreturn]] void refuse(const Objects& objects) {
  for (std::uint32_t i = 0;; ++i)
    check_boxes(
        {{Item{objects.boxes[i],
               {objects.owner, static_cast<LocalId>(static_cast<std::uint32_t>(objects.first) + i),
                objects.model}}}});
}

void check_numbers(LocalId first, std::size_t n) {
  constexpr std::uint64_t n_numbers = std::uint64_t{1} << 32;
  const auto begin = static_cast<std::uint64_t>(first);
  if (begin + n > n_numbers)
    fail(ErrorCode::bad_value, "collider: ", n, " objects numbered from ", begin,
         " on were submitted; their numbers have 32 bits: give a first one of at most ",
         n_numbers - n);
}

/// Begins to load boxes, which the processor does not foresee from one block to the next.
void prefetch(std::span<const Aabb> boxes) {
  const auto bytes = std::as_bytes(boxes);
  constexpr std::size_t line = 64;
  for (std::size_t i = 0; i < bytes.size(); i += line) __builtin_prefetch(&bytes[i]);
}

}  // namespace

/// Entries have 28 bits for an object.
void ObjectList::check_room(std::size_t n_more, std::size_t n_capsules) const {
  if (boxes_.size() + n_more > search::most_objects)
    fail(ErrorCode::bad_value, "collider: ", boxes_.size() + n_more,
         " objects were submitted on one PE; the limit is ", search::most_objects,
         ": spread them over more PEs");
  if (n_capsules != 0 && n_capsules != n_more)
    fail(ErrorCode::bad_value, "collider: ", n_capsules, " capsules were submitted with ", n_more,
         " objects: give one per object, or none");
}

void ObjectList::add_capsules(std::span<const Capsule> capsules) {
  if (capsules.empty() && capsules_.empty()) return;
  capsules_.resize(boxes_.size() - capsules.size(), unknown_capsule);
  std::transform(capsules.begin(), capsules.end(), std::back_inserter(capsules_), checked);
}

void ObjectList::set_sources() {
  if (source_of_.empty()) source_of_.assign(boxes_.size(), 0);
}

void ObjectList::number_objects() {
  set_sources();
  local_.reserve(boxes_.size());
  for (auto i = static_cast<std::uint32_t>(local_.size()); i < boxes_.size(); ++i)
    local_.push_back(i + sources_[source_of_[i]].shift);
}

/// For a list whose objects have numbers.
std::uint32_t ObjectList::find_source(Source wanted) {
  wanted.shift = 0;
  const auto is_wanted = [&](const Source& known) { return SameOrigin{}(known, wanted); };
  // Most objects have the source of the one before.
  if (!sources_.empty() && is_wanted(sources_.back()))
    return static_cast<std::uint32_t>(sources_.size() - 1);
  auto at = static_cast<std::uint32_t>(sources_.size());
  constexpr std::size_t few = 8;
  if (sources_.size() < few) {
    const auto known = std::find_if(sources_.begin(), sources_.end(), is_wanted);
    at = static_cast<std::uint32_t>(known - sources_.begin());
  } else {
    if (places_.empty())
      for (std::uint32_t i = 0; i < sources_.size(); ++i) places_.try_emplace(sources_[i], i);
    if (const auto known = places_.find(wanted); known != places_.end()) at = known->second;
  }
  if (at == sources_.size()) add_source(wanted);
  return at;
}

void ObjectList::add_source(const Source& source) {
  several_models_ = several_models_ || (!sources_.empty() && sources_.back().model != source.model);
  if (!places_.empty()) places_.try_emplace(source, static_cast<std::uint32_t>(sources_.size()));
  sources_.push_back(source);
}

/// One pass over the boxes, in blocks that stay in the cache: they are checked, surveyed and
/// copied. Only then does the list have them.
void ObjectList::append(const Objects& objects, PeId pe) {
  const std::size_t n = objects.boxes.size(), begin = boxes_.size();
  check_room(n, objects.capsules.size());
  if (n == 0) return;
  check_numbers(objects.first, n);
  boxes_.reserve(begin + n);
  Aabb bounds = bounds_;
  std::array<std::uint8_t, search::Octaves::n> octaves = octaves_;
  constexpr std::size_t most = 128;
  for (std::size_t at = 0; at < n; at += most) {
    const auto block = objects.boxes.subspan(at, std::min(most, n - at));
    if (at + 2 * most <= n) prefetch(objects.boxes.subspan(at + most, most));
    try {
      bounds = merged(bounds, search::checked_bounds(block, ""));
    } catch (const Error&) {
      refuse(objects);
    }
    for (const Aabb& box : block) octaves[search::octave_of(search::longest_extent(box))] = 1;
    std::memcpy(boxes_.data() + begin + at, block.data(), block.size_bytes());
  }
  bounds_ = bounds;
  octaves_ = octaves;
  const Source source{
      objects.owner, objects.model, pe,
      static_cast<std::uint32_t>(objects.first) - static_cast<std::uint32_t>(begin)};
  if (sources_.empty() || sources_.back() != source) add_source(source);
  if (sources_.size() > 1 || !source_of_.empty()) {
    set_sources();
    source_of_.insert(source_of_.end(), n, static_cast<std::uint32_t>(sources_.size() - 1));
  }
  boxes_.resize(begin + n);
  if (!local_.empty()) number_objects();
  add_capsules(objects.capsules);
}

void ObjectList::append(std::span<const Item> items, std::span<const Capsule> capsules, PeId pe) {
  check_room(items.size(), capsules.size());
  if (items.empty()) return;
  check_boxes(items);
  number_objects();
  for (const Item& item : items) {
    boxes_.push_back(item.box);
    bounds_ = merged(bounds_, item.box);
    octaves_[search::octave_of(search::longest_extent(item.box))] = 1;
    source_of_.push_back(find_source({item.id.owner, item.id.model, pe, 0}));
    local_.push_back(static_cast<std::uint32_t>(item.id.local));
  }
  add_capsules(capsules);
}

void ObjectList::divide(const search::Frame& frame, double longest, PeId pe) {
  number_objects();
  std::swap(boxes_, undivided_);
  boxes_.resize(0);
  const std::uint32_t n_objects = static_cast<std::uint32_t>(undivided_.size());
  const std::vector<std::uint32_t> source_of = std::move(source_of_), local = std::move(local_);
  source_of_.clear();
  local_.clear();
  for (std::uint32_t i = 0; i < n_objects; ++i) {
    const Aabb& box = undivided_.data()[i];
    const std::size_t begin = boxes_.size();
    int n = search::n_pieces(capsule(i), longest);
    // Entries have 28 bits.
    if (begin + static_cast<std::size_t>(n) + n_objects - i > search::most_objects) n = 1;
    pieces_.add_object({box, capsule(i), static_cast<std::uint64_t>(pe.value) << 32 | i, n, 0},
                       frame);
    boxes_.resize(begin + static_cast<std::size_t>(n));
    const Aabb* const end = search::cut(box, capsule(i), n, boxes_.data() + begin);
    boxes_.resize(static_cast<std::size_t>(end - boxes_.data()));
    for (std::uint32_t piece = 0; piece < boxes_.size() - begin; ++piece) pieces_.add_piece(piece);
    source_of_.resize(boxes_.size(), source_of[i]);
    local_.resize(boxes_.size(), local[i]);
  }
}

/// A list keeps the numbers of the sources only from the second source on.
void ObjectList::append(const ObjectList& from, std::span<const search::Entry> entries,
                        std::vector<search::Entry>& copies) {
  constexpr std::size_t ahead = 16;
  const std::uint32_t begin = size();
  if (begin != 0 && local_.empty()) number_objects();
  boxes_.resize(begin + entries.size());
  local_.resize(begin + entries.size());
  std::uint32_t source = ~std::uint32_t{0}, at = 0;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const std::uint32_t object = search::object_of(entries[i]), to = begin + i;
    if (i + ahead < entries.size())
      prefetch(from.boxes().subspan(search::object_of(entries[i + ahead]), 1));
    if (from.source(object) != source) {
      source = from.source(object);
      at = find_source(from.sources_[source]);
      if (at != 0 && source_of_.empty()) source_of_.assign(to, 0);
    }
    if (!source_of_.empty()) source_of_.push_back(at);
    boxes_.data()[to] = from.boxes_.data()[object];
    local_[to] = static_cast<std::uint32_t>(from.local(object, source));
    if (!from.pieces_.empty()) pieces_.append(from.pieces_, object);
    copies.push_back(search::make_entry(to, search::below_of(entries[i])));
  }
}

void ObjectList::clear() {
  boxes_.resize(0);
  sources_.clear();
  if (!places_.empty()) places_.clear();  // which passes over all its memory
  source_of_.clear();
  local_.clear();
  capsules_.clear();
  pieces_.clear();
  several_models_ = false;
  bounds_ = no_box<double, 3>();
  octaves_.fill(0);
}

}  // namespace tess::collide
