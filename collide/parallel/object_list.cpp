#include "collide/parallel/object_list.hpp"

#include "collide/search/entry.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tess::collide {

/// Entries have 28 bits for an object.
void ObjectList::check_room(std::size_t n_more) const {
  if (boxes_.size() + n_more > search::most_objects)
    fail(ErrorCode::bad_value, "collider: ", boxes_.size() + n_more,
         " objects were submitted on one PE; the limit is ", search::most_objects,
         ": spread them over more PEs");
}

void ObjectList::number_objects() {
  if (local_.size() == boxes_.size()) return;
  source_of_.assign(boxes_.size(), 0);
  local_.resize(boxes_.size());
  std::iota(local_.begin(), local_.end(), 0U);
}

std::uint32_t ObjectList::source(OwnerId owner, ModelId model) {
  const Source wanted{owner, model, 0};
  // Most objects have the source of the one before.
  if (!sources_.empty() && sources_.back() == wanted)
    return static_cast<std::uint32_t>(sources_.size() - 1);
  const auto known = std::find(sources_.begin(), sources_.end(), wanted);
  const auto at = static_cast<std::uint32_t>(known - sources_.begin());
  if (known == sources_.end()) sources_.push_back(wanted);
  return at;
}

void ObjectList::append(Objects objects) {
  for (std::size_t i = 0; i < objects.boxes.size(); ++i)
    if (!is_valid(objects.boxes[i]))
      check_boxes(
          {{Item{objects.boxes[i], {objects.owner, static_cast<LocalId>(i), objects.model}}}});
  if (objects.boxes.empty()) return;
  check_room(objects.boxes.size());
  const std::uint32_t of = source(objects.owner, objects.model);
  if (boxes_.empty() && of == 0) {
    boxes_ = std::move(objects.boxes);
    return;
  }
  number_objects();
  const std::size_t n = objects.boxes.size();
  boxes_.insert(boxes_.end(), objects.boxes.begin(), objects.boxes.end());
  source_of_.insert(source_of_.end(), n, of);
  local_.resize(local_.size() + n);
  std::iota(local_.end() - static_cast<std::ptrdiff_t>(n), local_.end(), 0U);
}

void ObjectList::append(std::span<const Item> items) {
  check_boxes(items);
  check_room(items.size());
  number_objects();
  boxes_.reserve(boxes_.size() + items.size());
  for (const Item& item : items) {
    boxes_.push_back(item.box);
    source_of_.push_back(source(item.id.owner, item.id.model));
    local_.push_back(static_cast<std::uint32_t>(item.id.local));
  }
}

void ObjectList::append(const ObjectList& from, std::uint32_t object) {
  const ObjectId id = from.id(object);
  boxes_.push_back(from.boxes_[object]);
  source_of_.push_back(source(id.owner, id.model));
  local_.push_back(static_cast<std::uint32_t>(id.local));
}

bool ObjectList::has_one_model() const noexcept {
  return std::all_of(sources_.begin(), sources_.end(),
                     [&](const Source& s) { return s.model == sources_.front().model; });
}

}  // namespace tess::collide
