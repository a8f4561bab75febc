// What a search found, and what became of the elements of the files, in reports.
#pragma once

#include "apps/kit/json.hpp"
#include "apps/m2m_transfer/report.hpp"

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
      "{} covered more than once, up to {:.6g} times: tetrahedra of the source "
      "overlap there, and values are wrong",
      tally.n_overcovered, tally.most_covered);
}

}  // namespace m2m_transfer
