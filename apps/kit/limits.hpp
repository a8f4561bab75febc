// What limits a run, for the JSON of a program: the shares, and the sentence that it prints.
#pragma once

#include "apps/kit/rows.hpp"
#include "runtime/core/load_summary.hpp"

namespace kit {

[[nodiscard]] inline Json limits_json(const tess::LoadSummary& of) {
  const auto share = [](double value) { return value < 0 ? Json() : rounded(value); };
  return {{"wait_share", share(of.wait)},       {"balance_share", share(of.balance)},
          {"largest_element", of.largest},      {"largest_element_share", share(of.element)},
          {"runtime_share", share(of.runtime)}, {"sentence", tess::describe(of)}};
}

}  // namespace kit
