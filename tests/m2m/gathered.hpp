// What the Workers of a mesh hold after a transfer, vertex by vertex.
#pragma once

#include "m2m/transfer.hpp"

#include <algorithm>

namespace tess::test {

/// The outcome of a transfer into the mesh, with its vertices in ascending order.
inline TaskOf<m2m::Outcome> gathered(m2m::DistributedMesh mesh) {
  const m2m::Outcome all = co_await mesh.workers.reduce<&m2m::Worker::gather>();
  m2m::Outcome out = all;
  const std::size_t n = all.points.size();
  const auto sort = [&](const auto& from, auto& to) {
    const std::size_t width = n == 0 ? 0 : from.size() / n;
    for (std::size_t i = 0; i < n; ++i)
      std::copy_n(from.data() + i * width, width,
                  to.data() + static_cast<std::size_t>(all.points[i]) * width);
  };
  sort(all.points, out.points);
  sort(all.status, out.status);
  sort(all.values, out.values);
  sort(all.distance, out.distance);
  co_return out;
}

}  // namespace tess::test
