#include "m2m/write_pvd.hpp"

#include "m2m/io/new_file.hpp"
#include "m2m/write_vtu.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"

#include <fmt/core.h>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::string_view ending = ".pvd";

std::string name_of_file(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

}  // namespace

PvdSeries::PvdSeries(std::string path) : path_(std::move(path)) {
  if (!path_.ends_with(ending))
    fail(ErrorCode::bad_argument, path_, ": a series of VTU files ends in .pvd; rename it");
  if (xml_characters(name_of_file(path_)) != name_of_file(path_))
    fail(ErrorCode::bad_argument, path_,
         ": XML, which names the steps, cannot hold the name of this file; choose one in UTF-8 "
         "without control characters");
}

void PvdSeries::add(double time, const TetMesh& mesh, std::span<const Field> vertex_fields,
                    std::span<const Field> tet_fields) {
  if (!(time > last_time_))
    fail(ErrorCode::bad_value, path_, ": step ", n_steps_, " has time ", time,
         ", which is not after ", last_time_, "; add steps in the order of time");
  const std::string step = path_of_step(path_, n_steps_);
  write_vtu(step, mesh, vertex_fields, tet_fields, time);
  ++n_steps_;
  last_time_ = time;
  entries_ += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time,
                          xml_text(name_of_file(step)));
  NewFile file(path_);
  file.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n" +
      entries_ + "  </Collection>\n</VTKFile>\n");
  file.finish();
}

std::string PvdSeries::path_of_step(const std::string& path, std::size_t step) {
  return fmt::format("{}.{}.vtu", path.substr(0, path.size() - ending.size()), step);
}

}  // namespace tess::m2m
