// What a study or a drift table leaves: the file of --json, and in the folder of --plot the rows as
// CSV and JSON, and pictures.
#pragma once

#include "apps/kit/driver.hpp"
#include "apps/kit/output/chart.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

struct Picture {
  std::string name;  ///< without the ending
  kit::Chart chart;
};

/// What goes into the folder: NAME.csv, NAME.json, and an SVG with its CSV per picture.
struct Files {
  std::string name, csv;
  std::vector<Picture> pictures;
};

/// Writes all of them into an existing folder, none if it is empty, and prints a line that lists
/// them. `results` and `more` as in Driver::write().
void write(const kit::Driver& driver, const std::string& folder, const Files& files,
           const kit::Json& results, const kit::Json& more = {});

}  // namespace m2m_transfer
