#include "m2m/write_pvtu.hpp"

#include "m2m/io/new_file.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace tess::m2m {
namespace {

/// `file`: "r", whose parts are called r.0.vtu and so on.
std::string index_of_parts(const std::string& file, std::int32_t n_parts,
                           const std::vector<std::string>& names) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PUnstructuredGrid "
      "GhostLevel=\"0\">\n    <PPointData>\n";
  for (const std::string& name : names)
    out += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"/>\n", xml_text(name));
  out +=
      "    </PPointData>\n    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" "
      "NumberOfComponents=\"3\"/>\n    </PPoints>\n";
  for (std::int32_t k = 0; k < n_parts; ++k)
    out += fmt::format("    <Piece Source=\"{}.{}.vtu\"/>\n", xml_text(file), k);
  return out + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

Task write_pvtu(std::string path, DistributedMesh mesh, std::vector<std::string> names) {
  if (names.size() != mesh.n_components)
    fail(ErrorCode::bad_argument, path, ": ", names.size(), " names are given for ",
         mesh.n_components, " components; give one per component");
  const std::string ending = ".pvtu";
  if (!path.ends_with(ending))
    fail(ErrorCode::bad_argument, path, ": a file that names parts ends in .pvtu; rename it");
  const std::string stem = path.substr(0, path.size() - ending.size());
  const std::string file_name = stem.substr(stem.rfind('/') + 1);
  if (xml_characters(file_name) != file_name)
    fail(ErrorCode::bad_argument, path,
         ": XML, which names the parts, cannot hold the name of this file; choose one in UTF-8 "
         "without control characters");
  names.emplace_back("status");
  for (std::string& name : names) name = xml_characters(name);  // names that differ may become one
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (name->empty()) fail(ErrorCode::bad_argument, path, ": a field has no name; name it");
    if (std::find(names.begin(), name, *name) != name)
      fail(ErrorCode::bad_argument, path, ": two fields have the name '", *name,
           "'; give each field a name of its own, other than 'status'");
  }
  NewFile file(path);  // refuses a folder that cannot be written, before a part does
  file.write(index_of_parts(file_name, mesh.n_parts, names));
  co_await epoch([&] { mesh.workers.broadcast<&Worker::share_status>(); });
  co_await epoch([&] { mesh.workers.broadcast<&Worker::write_part>(stem, names); });
  file.finish();
}

}  // namespace tess::m2m
