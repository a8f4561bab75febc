// The format of a result: the ending of its path chooses ExodusII or VTU.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_pvd.hpp"
#include "m2m/write_vtu.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace m2m_transfer {

[[nodiscard]] inline bool is_vtu(const std::string& path) {
  return path.ends_with(".vtu");
}

/// A series of VTU files, one per step.
[[nodiscard]] inline bool is_pvd(const std::string& path) {
  return path.ends_with(".pvd");
}

/// Each part writes a file of its own.
[[nodiscard]] inline bool is_pvtu(const std::string& path) {
  return path.ends_with(".pvtu");
}

/// The path of a result, or empty. Throws Error (bad_argument) if its ending names no format that
/// is written, or if the index of the parts cannot hold its name.
inline void require_result_format(const std::string& path) {
  constexpr std::array<std::string_view, 10> endings{".vtu", ".pvd", ".pvtu", ".exo", ".e",
                                                     ".ex2", ".g",   ".exii", ".gen", ".ncdf"};
  const bool is_known = std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) {
    return path.ends_with(ending);
  });
  if (!path.empty() && !is_known)
    fail(ErrorCode::bad_argument, "--out ", path,
         ": the ending chooses the format; give .exo (ExodusII), .vtu, .pvd (one file per "
         "step) or .pvtu (one file per chare; VTK)");
  const std::string file = path.substr(path.rfind('/') + 1);
  if ((is_pvtu(path) || is_pvd(path)) && xml_characters(file) != file)
    fail(ErrorCode::bad_argument, "--out ", path,
         ": XML, which names the parts, cannot hold this name; give one in UTF-8 without "
         "control "
         "characters");
}

/// Throws Error (bad_argument) if two of these fields would have one name in the result.
inline void require_names_differ(const std::string& path, const std::vector<std::string>& names) {
  if (!is_vtu(path) && !is_pvd(path)) return;
  for (std::size_t f = 0; f < names.size(); ++f)
    for (std::size_t g = 0; g < f; ++g)
      if (xml_characters(names[f]) == xml_characters(names[g]))
        fail(ErrorCode::bad_argument, "--out ", path, ": XML has one name, ",
             xml_characters(names[f]), ", for two fields; give a file that ends in .exo");
}

/// Throws Error (bad_file) with the path if it cannot be written.
inline void write_result(const std::string& path, const TetMesh& mesh,
                         const std::vector<Field>& fields) {
  if (is_vtu(path))
    write_vtu(path, mesh, fields);
  else if (is_pvd(path))
    PvdSeries(path).add(0, mesh, fields);
  else
    write_exodus(path, mesh, fields);
}

}  // namespace m2m_transfer
