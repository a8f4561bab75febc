// Writes results over time as a series for ParaView: "r.pvd" names a VTU file per step beside it,
// "r.0.vtu", "r.1.vtu", …, with their times. It is whole after each step, so that a run can be watched.
//
//     PvdSeries out("result.pvd");
//     for (int step = 0; step < 10; ++step) {
//       …
//       out.add(step * dt, mesh, std::array{temperature, velocity});
//     }
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <string>

namespace tess::m2m {

class PvdSeries {
 public:
  /// Writes nothing yet. Throws Error (bad_argument) if the path does not end in .pvd, or if XML
  /// cannot hold the name of the file.
  explicit PvdSeries(std::string path);

  /// Writes a step, as write_vtu() does, and the index of all. The mesh may change between steps.
  /// Throws Error as write_vtu(), and (bad_value) if the time is not after the last one.
  void add(double time, const TetMesh& mesh, std::span<const Field> vertex_fields,
           std::span<const Field> tet_fields = {});

  /// The file of a step: "r.3.vtu" beside "r.pvd".
  [[nodiscard]] static std::string path_of_step(const std::string& path, std::size_t step);

 private:
  std::string path_, entries_;
  std::size_t n_steps_ = 0;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace tess::m2m
