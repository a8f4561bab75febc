// The objects of several voxels, which a Manager sends to the Manager of another process that makes
// the voxels. They stand in one list, voxel after voxel, whose boxes are received where the voxels
// read them: a message per voxel costs memory and two copies for each.
#pragma once

#include "collide/parallel/part.hpp"
#include "runtime/core/index.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tess::collide {

class Shipment {
 public:
  /// A voxel, and what the shipment has for it.
  struct Stop {
    Index4 voxel;
    std::uint32_t n_natives = 0, n_visitors = 0;
    std::uint32_t n_senders = 0;  ///< PEs that send to the voxel
  };

  /// A part of a delivery on this PE.
  void add(const Stop& stop, std::span<const search::Entry> entries) {
    stops_.push_back(stop);
    loads_.push_back(entries);
    n_entries_ += entries.size();
  }
  /// Copies the objects of the parts, before the shipment is sent.
  void pack(const Delivery& from) {
    delivery_ = alone(from);
    delivery_->objects.reserve(n_entries_);
    delivery_->sorted.reserve(n_entries_);
    for (const auto entries : loads_)
      delivery_->objects.append(from.objects, entries, delivery_->sorted);
    loads_.clear();
  }

  /// Calls put(stop, part) for each voxel.
  template <class Put>
  void for_each(const Put& put) const {
    std::uint32_t begin = 0;
    for (const Stop& stop : stops_) {
      put(stop, Part(delivery_, begin, stop.n_natives, stop.n_visitors));
      begin += stop.n_natives + stop.n_visitors;
    }
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) delivery_ = std::make_shared<Delivery>();
    ar(stops_);
    delivery_->serialize(ar, delivery_);
  }

 private:
  std::shared_ptr<Delivery> delivery_;
  std::vector<Stop> stops_;
  std::vector<std::span<const search::Entry>> loads_;  // until they are packed
  std::size_t n_entries_ = 0;
};

}  // namespace tess::collide
