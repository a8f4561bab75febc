#include "apps/m2m_transfer/output/folder.hpp"

#include "apps/kit/output/write_file.hpp"

namespace m2m_transfer {

void write(const kit::Driver& driver, const std::string& folder, const Files& files,
           const kit::Json& results, const kit::Json& more) {
  driver.write(results, more);
  if (folder.empty()) return;
  const std::string stem = folder + "/" + files.name;
  kit::write_file(stem + ".csv", files.csv);
  kit::write_file(stem + ".json", kit::json_text(driver.document(results, more)));
  std::string said = "written: " + stem + ".csv, " + files.name + ".json";
  for (const auto& [name, chart] : files.pictures)
    said += ", " + name + (kit::write_svg(folder + "/" + name + ".svg", chart) ? ".svg" : ".csv");
  tess::print_text(said + '\n');
}

}  // namespace m2m_transfer
