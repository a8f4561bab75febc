// What a search found, where the target is farthest from the source, and what became of the
// elements of the files, in reports.
#pragma once

#include "apps/kit/output/json.hpp"
#include "apps/m2m_transfer/report.hpp"
#include "m2m/worst_places.hpp"

#include <array>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {

/// The title and the text of each line, "skipped" and "in the source: 120 TRI3".
[[nodiscard]] inline std::vector<std::pair<const char*, std::string>> lines_of(
    const OtherElements& source, const OtherElements& target) {
  std::vector<std::pair<const char*, std::string>> out;
  for (const auto& [title, part] :
       {std::pair("skipped", &OtherElements::skipped), std::pair("split", &OtherElements::split),
        std::pair("unused", &OtherElements::unused),
        std::pair("coincident", &OtherElements::coincident),
        std::pair("repeated", &OtherElements::repeated)})
    for (const auto& [side, elements] :
         {std::pair("in the source: ", &source), std::pair("in the target: ", &target)})
      if (!(elements->*part).empty()) out.emplace_back(title, side + elements->*part);
  return out;
}

[[nodiscard]] inline kit::Json json_of(const OtherElements& source, const OtherElements& target) {
  return {{"skipped", {{"source", source.skipped}, {"target", target.skipped}}},
          {"split", {{"source", source.split}, {"target", target.split}}},
          {"unused", {{"source", source.unused}, {"target", target.unused}}},
          {"coincident", source.coincident},
          {"repeated", source.repeated}};
}

[[nodiscard]] inline std::string found_text(const std::array<std::uint64_t, 4>& counts) {
  return fmt::format("{} inside, {} boundary, {} snapped, {} outside", counts[0], counts[1],
                     counts[2], counts[3]);
}

/// Empty if the source covers nothing more than once.
[[nodiscard]] inline std::string overcovered_text(const tess::m2m::Tally& tally) {
  if (tally.n_overcovered == 0) return {};
  return fmt::format(
      "{} covered more than once, up to {:.6g} times: cells of the source "
      "overlap there, and values are wrong",
      tally.n_overcovered, tally.most_covered);
}

/// Empty if all points of kind native have the shape functions of their elements.
[[nodiscard]] inline std::string linear_text(const tess::m2m::Tally& tally) {
  if (tally.n_linear == 0) return {};
  return fmt::format("{} in elements that fold over there or do not reach them: linear values",
                     tally.n_linear);
}

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
