// What a Manager sends to a voxel: the objects of its PE that touch it. Within a process the boxes
// stay where they are, and a part is a range of a list that all voxels share. To another process
// the boxes of several voxels are sent together (shipment.hpp), or those of one part.
#pragma once

#include "collide/hit_receivers.hpp"
#include "collide/parallel/object_list.hpp"
#include "collide/parallel/plan.hpp"
#include "collide/parallel/voxel_sort.hpp"
#include "collide/problem/entry.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tess::collide {

class Manager;

/// The objects of a PE in a collision, and which of them are in which voxel.
struct Delivery {
  Plan plan;
  HitReceivers receivers;
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
  /// `keeper` keeps this delivery, if its boxes may be sent from where they are.
  template <class Ar>
  void serialize(Ar& ar, const std::shared_ptr<const void>& keeper) {
    ar(plan, receivers, managers, sorted);
    objects.serialize(ar, keeper);
  }
};

/// A delivery of the same collision without objects.
[[nodiscard]] inline std::shared_ptr<Delivery> alone(const Delivery& from) {
  auto out = std::make_shared<Delivery>();
  out->plan = from.plan;
  out->receivers = from.receivers;
  out->managers = from.managers;
  return out;
}

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
  [[nodiscard]] std::span<const search::Entry> entries() const noexcept {
    return {delivery_->sorted.data() + begin_, n_natives_ + n_visitors_};
  }
  [[nodiscard]] std::span<const search::Entry> natives() const noexcept {
    return {delivery_->sorted.data() + begin_, n_natives_};
  }
  [[nodiscard]] std::span<const search::Entry> visitors() const noexcept {
    return {delivery_->sorted.data() + begin_ + n_natives_, n_visitors_};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      auto delivery = std::make_shared<Delivery>();
      ar(n_natives_, n_visitors_);
      delivery->serialize(ar, nullptr);
      begin_ = 0;
      delivery_ = std::move(delivery);
    } else {
      make_alone();
      ar(n_natives_, n_visitors_);
      const_cast<Delivery&>(*delivery_).serialize(ar, nullptr);
    }
  }

 private:
  /// Copies the objects of this part.
  void make_alone() {
    if (delivery_->sorted.size() == n_natives_ + n_visitors_) return;
    const std::shared_ptr<Delivery> copy = alone(*delivery_);
    copy->objects.append(delivery_->objects, entries(), copy->sorted);
    delivery_ = copy;
    begin_ = 0;
  }

  std::shared_ptr<const Delivery> delivery_;
  std::uint32_t begin_ = 0, n_natives_ = 0, n_visitors_ = 0;
};

}  // namespace tess::collide
