#include "apps/m2m_transfer/watch.hpp"

#include "apps/m2m_transfer/input/graph.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <cmath>

namespace m2m_transfer {

TetMesh watch_points(const std::vector<std::string>& texts) {
  TetMesh cloud;
  cloud.name = "--watch";
  for (const std::string& text : texts) {
    std::vector<double> numbers;
    for (const std::string& word : split_at_commas(text)) {
      const auto number = parse_number<double>(word);
      if (number && std::abs(*number) <= 1e100) numbers.push_back(*number);
    }
    if (numbers.size() != 3 || split_at_commas(text).size() != 3)
      fail(ErrorCode::bad_argument, "--watch: '", text,
           "' is no point; give X,Y,Z, and repeat the option for several");
    cloud.points.push_back({numbers[0], numbers[1], numbers[2]});
  }
  return cloud;
}

void add_watched(std::vector<Watched>& rows, double time, const TetMesh& cloud,
                 std::span<const Field> fields, std::span<const Status> status) {
  for (std::size_t i = 0; i < cloud.n_points(); ++i)
    for (const Field& field : fields)
      for (std::size_t k = 0; k < field.n_components; ++k) {
        Watched& row = rows.emplace_back(Watched{time, cloud.points[i], field.name, status[i]});
        if (field.n_components > 1) row.field += text("[", k, "]");
        if (status[i] != Status::outside) row.value = field.values[i * field.n_components + k];
      }
}

const kit::Rows<Watched>& watch_rows() {
  using R = const Watched&;
  using kit::Json;
  static constexpr kit::Column<Watched> columns[] = {
      {"time", "time", "10.6g", kit::of<&Watched::time>},
      {"x", "x", "10.6g", [](R r) -> Json { return r.at[0]; }},
      {"y", "y", "10.6g", [](R r) -> Json { return r.at[1]; }},
      {"z", "z", "10.6g", [](R r) -> Json { return r.at[2]; }},
      {"field", "field", "<", kit::of<&Watched::field>},
      {"value", "value", "14.8g", kit::of<&Watched::value>},
      {"status", "status", "<", [](R r) -> Json {
         return r.status == Status::outside   ? "outside"
                : r.status == Status::snapped ? "snapped"
                                              : "inside";
       }}};
  static const kit::Rows<Watched> rows(columns);
  return rows;
}

}  // namespace m2m_transfer
