// The format of a result: ExodusII, or VTU if the path ends in .vtu.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

[[nodiscard]] inline bool is_vtu(const std::string& path) {
  return path.ends_with(".vtu");
}

/// Throws Error (bad_file) with the path if it cannot be written.
inline void write_result(const std::string& path, const TetMesh& mesh,
                         const std::vector<Field>& fields) {
  if (is_vtu(path))
    write_vtu(path, mesh, fields);
  else
    write_exodus(path, mesh, fields);
}

}  // namespace m2m_transfer
