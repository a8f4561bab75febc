// What a Manager sends to a voxel: the objects of its PE that touch it. Within a process the boxes
// stay where they are, and a part is a range of a list that all voxels share; to another process only the
// boxes of the part are sent.
#pragma once

#include "collide/parallel/object_list.hpp"
#include "collide/parallel/plan.hpp"
#include "collide/parallel/report.hpp"
#include "collide/parallel/voxel_sort.hpp"
#include "collide/search/entry.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tess::collide {

class Manager;

/// The objects of a PE in a collision, and which of them are in which voxel.
struct Delivery {
  Plan plan;
  Report report;
  GroupProxy<Manager> managers;
  ObjectList objects;
  std::vector<search::Entry> sorted;  ///< by voxel
  VoxelSort sort;                     ///< on the PE of the objects

  /// Keeps the memory.
  void clear() {
    objects.clear();
    sorted.clear();
    sort.clear();
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(plan, report, managers, objects, sorted);
  }
};

class Part {
 public:
  Part() = default;
  /// Objects from `begin` on: those of the voxel's level, then smaller ones that visit it.
  Part(std::shared_ptr<const Delivery> delivery, std::uint32_t begin, std::uint32_t n_natives,
       std::uint32_t n_visitors)
      : delivery_(std::move(delivery)),
        begin_(begin),
        n_natives_(n_natives),
        n_visitors_(n_visitors) {}

  [[nodiscard]] const Delivery& delivery() const noexcept { return *delivery_; }
  [[nodiscard]] std::span<const search::Entry> natives() const noexcept {
    return {delivery_->sorted.data() + begin_, n_natives_};
  }
  [[nodiscard]] std::span<const search::Entry> visitors() const noexcept {
    return {delivery_->sorted.data() + begin_ + n_natives_, n_visitors_};
  }

  /// Adds the objects of some of its entries to a list, and their entries there.
  void copy(std::span<const search::Entry> entries, ObjectList& objects,
            std::vector<search::Entry>& copies) const {
    for (const search::Entry entry : entries) {
      const std::uint32_t n = objects.size();
      objects.append(delivery_->objects, search::object_of(entry));
      copies.push_back(search::make_entry(n, search::below_of(entry)));
    }
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      auto alone = std::make_shared<Delivery>();
      ar(n_natives_, n_visitors_, *alone);
      begin_ = 0;
      delivery_ = std::move(alone);
    } else {
      make_alone();
      ar(n_natives_, n_visitors_, *delivery_);
    }
  }

 private:
  /// Copies the objects of this part.
  void make_alone() {
    if (delivery_->sorted.size() == n_natives_ + n_visitors_) return;
    auto alone = std::make_shared<Delivery>();
    alone->plan = delivery_->plan;
    alone->report = delivery_->report;
    alone->managers = delivery_->managers;
    copy(natives(), alone->objects, alone->sorted);
    copy(visitors(), alone->objects, alone->sorted);
    delivery_ = std::move(alone);
    begin_ = 0;
  }

  std::shared_ptr<const Delivery> delivery_;
  std::uint32_t begin_ = 0, n_natives_ = 0, n_visitors_ = 0;
};

}  // namespace tess::collide
