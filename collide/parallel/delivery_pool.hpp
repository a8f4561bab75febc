// Deliveries that are in use no more are kept with their memory: for a million objects, touching
// new memory in each collision costs more than gridding them. The last user of a delivery, a voxel
// on any PE of the process, gives it back.
#pragma once

#include "collide/parallel/part.hpp"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tess::collide {

class DeliveryPool {
 public:
  /// An empty one.
  [[nodiscard]] std::shared_ptr<Delivery> take() {
    std::unique_ptr<Delivery> out;
    {
      const std::lock_guard lock(free_->mutex);
      if (!free_->list.empty()) {
        out = std::move(free_->list.back());
        free_->list.pop_back();
      }
    }
    if (out == nullptr) out = std::make_unique<Delivery>();
    return {out.release(), [free = free_](Delivery* used) {
              std::unique_ptr<Delivery> delivery(used);
              delivery->clear();
              const std::lock_guard lock(free->mutex);
              free->list.push_back(std::move(delivery));
            }};
  }
  /// Frees what is not in use.
  void shrink() {
    const std::lock_guard lock(free_->mutex);
    free_->list.clear();
  }

 private:
  struct Free {
    std::mutex mutex;
    std::vector<std::unique_ptr<Delivery>> list;
  };
  std::shared_ptr<Free> free_ = std::make_shared<Free>();  // outlives the deliveries
};

}  // namespace tess::collide
