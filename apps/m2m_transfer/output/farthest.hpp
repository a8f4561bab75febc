// The target vertices that lie farthest from the source, in reports.
#pragma once

#include "apps/kit/json.hpp"
#include "m2m/worst_places.hpp"

#include <fmt/format.h>
#include <string>
#include <vector>

namespace m2m_transfer {

/// "vertex 17 at (0, 0.5, 1): 0.125, outside", a text per place.
[[nodiscard]] inline std::vector<std::string> texts_of(const tess::m2m::WorstPlaces& places) {
  std::vector<std::string> out;
  for (const tess::m2m::WorstPlace& p : places.list())
    out.push_back(fmt::format("vertex {} at ({:.6g}, {:.6g}, {:.6g}): {:.4g}, {}", p.point, p.at[0],
                              p.at[1], p.at[2], p.distance, name_of(p.status)));
  return out;
}

[[nodiscard]] inline kit::Json json_of(const tess::m2m::WorstPlaces& places) {
  kit::Json out = kit::Json::array();
  for (const tess::m2m::WorstPlace& p : places.list())
    out.push_back({{"vertex", p.point},
                   {"at", p.at},
                   {"distance", p.distance},
                   {"status", name_of(p.status)}});
  return out;
}

}  // namespace m2m_transfer
