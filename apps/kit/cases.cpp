#include "apps/kit/cases.hpp"

#include "apps/kit/driver.hpp"

#include <fmt/format.h>

namespace kit {

Json value_of_case(const Case& one) {
  return one.parameter.empty() ? Json() : Json(one.value);
}

Json verdict(const Case& one) {
  return std::string(one.ok ? "ok" : "FAILED") + (one.note.empty() ? "" : ": " + one.note);
}

int finish_cases(const Driver& driver, const Json& results, std::size_t n_failed,
                 const std::string& remark) {
  driver.write(results);
  tess::print_text(remark +
                   fmt::format("{} cases, {} failed\n", results.members().size(), n_failed));
  return n_failed == 0 ? 0 : 1;
}

}  // namespace kit
