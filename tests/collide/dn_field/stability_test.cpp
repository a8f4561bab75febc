#include "apps/particles/stability/cases.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess::dn;

TEST_CASE("every stiff and extreme case meets its tolerance", "[dn_field][rules]") {
  const auto rows = stability_report();
  CHECK(rows.size() > 300);
  for (const kit::Case& row : rows) {
    INFO(row.name << ", " << row.parameter << " = " << *row.value << ": " << *row.met << " > "
                  << *row.tolerance);
    CHECK(row.ok);
  }
}

}  // namespace
