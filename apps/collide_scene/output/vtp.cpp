#include "apps/collide_scene/output/files.hpp"
#include "apps/collide_scene/output/view.hpp"

#include <bit>
#include <fmt/format.h>

namespace collide_scene {
namespace {
using tess::collide::Aabb;
using tess::collide::Point;

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

/// A VTP file: arrays are appended one after the other, each behind its size in 64 bits.
class VtpFile {
 public:
  template <class T>
  std::string array(const char* name, const char* type, int n_components,
                    const std::vector<T>& values) {
    const std::uint64_t offset = data_.size(), n_bytes = values.size() * sizeof(T);
    data_.append(reinterpret_cast<const char*>(&n_bytes), sizeof n_bytes);
    if (n_bytes > 0) data_.append(reinterpret_cast<const char*>(values.data()), n_bytes);
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, n_components, offset);
  }

  /// `cells`: Polys or Lines, of `size` points each, in the order of the points.
  std::string text(const char* cells, std::size_t size, const std::vector<Point>& points,
                   const std::string& cell_data) {
    std::vector<std::int64_t> connectivity(points.size()), offsets(points.size() / size);
    for (std::size_t i = 0; i < connectivity.size(); ++i)
      connectivity[i] = static_cast<std::int64_t>(i);
    for (std::size_t i = 0; i < offsets.size(); ++i)
      offsets[i] = static_cast<std::int64_t>((i + 1) * size);
    const std::string of_points = array("Points", "Float64", 3, points);
    const std::string of_cells =
        array("connectivity", "Int64", 1, connectivity) + array("offsets", "Int64", 1, offsets);
    return fmt::format(
               "<?xml version=\"1.0\"?>\n"
               "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
               "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" "
               "Number{}=\"{}\">\n<CellData>\n{}</CellData>\n<Points>\n{}</Points>\n"
               "<{}>\n{}</{}>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
               points.size(), std::string("Of") + cells, offsets.size(), cell_data, of_points,
               cells, of_cells, cells) +
           data_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string data_;
};

}  // namespace

std::string hits_vtp(const Scene& scene, std::span<const std::uint32_t> n_hits) {
  std::vector<Point> points;
  std::vector<std::uint32_t> hits, models, numbers;
  const auto add_cell = [&](std::size_t object) {
    hits.push_back(n_hits[object]);
    models.push_back(scene.models.empty() ? 0 : scene.models[object]);
    numbers.push_back(static_cast<std::uint32_t>(object));
  };
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Point& point : scene.triangles[t].corners) points.push_back(point);
    add_cell(t);
  }
  for (std::size_t b = 0; b < scene.boxes.size(); ++b)
    for (const auto& face : faces_of(scene.boxes[b])) {
      points.insert(points.end(), face.begin(), face.end());
      add_cell(scene.triangles.size() + b);
    }
  VtpFile file;
  const std::string cell_data = file.array("hits", "UInt32", 1, hits) +
                                file.array("model", "UInt32", 1, models) +
                                file.array("object", "UInt32", 1, numbers);
  return file.text("Polys", scene.triangles.empty() ? 4 : 3, points, cell_data);
}

std::string pairs_vtp(const Scene& scene, std::span<const ScenePair> pairs) {
  const std::vector<Aabb> boxes = boxes_of(scene);
  std::vector<Point> points;
  std::vector<std::uint32_t> first, second;
  for (const ScenePair& pair : pairs) {
    for (const std::uint32_t object : {pair.first, pair.second}) {
      const Aabb& box = boxes[object];
      Point& centre = points.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) centre[k] = box.lo[k] + 0.5 * (box.hi[k] - box.lo[k]);
    }
    first.push_back(pair.first);
    second.push_back(pair.second);
  }
  VtpFile file;
  const std::string cell_data =
      file.array("first", "UInt32", 1, first) + file.array("second", "UInt32", 1, second);
  return file.text("Lines", 2, points, cell_data);
}

}  // namespace collide_scene
