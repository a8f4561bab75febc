#include "m2m/field_file.hpp"

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/file_format.hpp"
#include "runtime/core/error.hpp"

#include <fmt/core.h>

namespace tess::m2m {

struct FieldFile::Opened {
  std::string path;
  FileBytes bytes;
  std::unique_ptr<FieldReader> reader{};
};

namespace {

std::string names_of(const std::vector<FileField>& fields, FieldPlace place) {
  std::string out;
  for (const FileField& field : fields) {
    if (field.place != place || field.is_part) continue;
    if (!out.empty()) out += ", ";
    out += field.name;
    if (field.n_components > 1) out += fmt::format(" ({} components)", field.n_components);
  }
  return out.empty() ? "none" : out;
}

std::string steps_of(const std::vector<double>& times) {
  if (times.empty()) return "no time steps";
  if (times.size() == 1) return fmt::format("step 0 (time {:.6g})", times[0]);
  return fmt::format("steps 0..{} (times {:.6g} to {:.6g})", times.size() - 1, times.front(),
                     times.back());
}

constexpr const char* text_of(FieldPlace place) {
  return place == FieldPlace::vertices ? "at vertices" : "in elements";
}

}  // namespace

FieldFile::FieldFile(const std::string& path) {
  if (path.starts_with("kuhn:"))
    fail(ErrorCode::bad_argument, path,
         ": is generated, so it has no fields; give a formula, or a file");
  opened_.reset(new Opened{path, FileBytes(path)});
  const std::string_view bytes = opened_->bytes.view();
  opened_->reader = file_format(path, bytes).read_fields(opened_->path, bytes);
}
FieldFile::~FieldFile() = default;
FieldFile::FieldFile(FieldFile&&) noexcept = default;
FieldFile& FieldFile::operator=(FieldFile&&) noexcept = default;

const std::vector<FileField>& FieldFile::fields() const noexcept {
  return opened_->reader->fields();
}
const std::vector<double>& FieldFile::times() const noexcept {
  return opened_->reader->times();
}

Field FieldFile::vertex_field(const TetMesh& mesh, std::string_view name, std::size_t step) const {
  return read(mesh, name, FieldPlace::vertices, step);
}
Field FieldFile::tet_field(const TetMesh& mesh, std::string_view name, std::size_t step) const {
  return read(mesh, name, FieldPlace::tets, step);
}

Field FieldFile::read(const TetMesh& mesh, std::string_view name, FieldPlace place,
                      std::size_t step) const {
  const std::string& path = opened_->path;
  std::size_t at = 0;
  while (at < fields().size() && (fields()[at].place != place || fields()[at].name != name)) ++at;
  if (at == fields().size()) {
    const FieldPlace other =
        place == FieldPlace::vertices ? FieldPlace::tets : FieldPlace::vertices;
    fail(ErrorCode::bad_value, path, ": has no variable '", name, "' ", text_of(place),
         "; it has: ", names_of(fields(), place), " (", text_of(other), ": ",
         names_of(fields(), other), "); ", steps_of(times()));
  }
  for (std::size_t other = at + 1; other < fields().size(); ++other)
    if (fields()[other].place == place && fields()[other].name == name)
      fail(ErrorCode::bad_value, path, ": there are two variables '", name, "' ", text_of(place),
           "; give each a name of its own");
  if (step >= n_steps())
    fail(ErrorCode::bad_value, path, ": variable '", name, "' has no step ", step,
         "; the file has ", steps_of(times()));
  const FileField& field = fields()[at];
  return {field.name, field.n_components, opened_->reader->read(mesh, at, step)};
}

}  // namespace tess::m2m
