#include "apps/row_files.hpp"

#include "apps/plot/file_names.hpp"
#include "apps/plot/write_file.hpp"
#include "runtime/core/error.hpp"
#include "runtime/here.hpp"

namespace apps {

void RowFiles::add_options(tess::CommandLine& line) {
  line.option("--json FILE", json_, "write the rows to this file");
  line.option("--plot FILE", picture_, "with --study: draw them to this SVG file");
}

void RowFiles::check(bool is_study, const std::string& trace) const {
  if (!picture_.empty() && !is_study)
    tess::fail(tess::ErrorCode::bad_argument, "--plot ", picture_, ": needs --study");
  plot::require_writable("--json", json_);
  plot::require_picture("--plot", picture_);
  plot::FileNames names;
  names.writes("--trace", trace);
  names.writes("--json", json_);
  names.writes_picture("--plot", picture_);
}

void RowFiles::write(const plot::Json& rows, const plot::Chart& chart) const {
  const plot::Json file{{"machine", tess::machine().describe()}, {"results", rows}};
  if (!json_.empty()) plot::write_file(json_, plot::json_text(file));
  if (!picture_.empty()) (void)plot::write_svg(picture_, chart);
}

}  // namespace apps
