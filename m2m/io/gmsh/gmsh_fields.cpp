#include "m2m/io/field_reader.hpp"
#include "m2m/io/gmsh/gmsh_format.hpp"
#include "m2m/io/gmsh/gmsh_reader.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace tess::m2m {
namespace {

/// $NodeData and $ElementData. A section holds one step of one view, or a part of it, in gmsh's
/// partitioned files. Sections are listed when the file is opened; read() reads those of one step.
class GmshFields : public FieldReader {
 public:
  GmshFields(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {
    GmshScanner file(path_, bytes_);
    bool have_format = false;
    for (file.skip_blanks(); !file.at_end(); file.skip_blanks()) {
      const std::string section(file.word());
      if (section == "$MeshFormat") {
        binary_ = read_gmsh_format(file).binary;
        have_format = true;
      } else if ((section == "$NodeData" || section == "$ElementData") && have_format) {
        list(file, section == "$NodeData" ? FieldPlace::vertices : FieldPlace::tets);
      } else if (section.size() > 1 && section[0] == '$' && section.size() < 64) {
        file.skip_to("$End" + section.substr(1));
      } else {
        file.damaged("expected a section such as $Nodes");
      }
    }
    // Views of several steps say when these are; many writers give a view of one step no time.
    for (const bool several : {true, false})
      for (const std::vector<Section>& sections : sections_)
        if (has_several_steps(sections) == several)
          for (const Section& section : sections) time_of_.try_emplace(section.step, section.time);
    for (const auto& [step, time] : time_of_) times_.push_back(time);
  }

  [[nodiscard]] std::vector<double> read(const TetMesh& mesh, std::size_t field,
                                         std::size_t step) const override {
    const FileField& wanted = fields_[field];
    const bool nodal = wanted.place == FieldPlace::vertices;
    GmshTags tags;
    // The tags come from the mesh; they are not kept, since few meshes are read for their fields.
    check_n_points(
        mesh, static_cast<std::int64_t>(read_gmsh(path_, bytes_, mesh.dimension, &tags).n_points()),
        path_);
    GmshScanner file(path_, bytes_);
    GmshTagMap places;
    const std::vector<std::uint64_t>& list = nodal ? tags.nodes : tags.cells;
    places.build(list, file, nodal ? "node" : "element");
    std::vector<double> values(list.size() * wanted.n_components);
    std::vector<bool> has(list.size());
    const int step_tag = std::next(time_of_.begin(), static_cast<std::ptrdiff_t>(step))->first;
    check_times(field, step_tag, times_[step]);
    for (const Section& section : sections_[field])
      if (section.step == step_tag) read(file, section, wanted, places, values, has);
    const auto missing = std::find(has.begin(), has.end(), false);
    if (!has.empty() && std::find(has.begin(), has.end(), true) == has.end())
      fail(ErrorCode::bad_value, path_, ": variable '", wanted.name, "' has no values at step ",
           step, " (time ", times_[step],
           "); choose a step at which it has some: ", steps_of(field));
    if (missing != has.end())
      fail(ErrorCode::bad_value, path_, ": variable '", wanted.name, "' has no value for ",
           nodal ? "node " : "element ", list[static_cast<std::size_t>(missing - has.begin())],
           " at step ", step, " (time ", times_[step], ", ",
           std::count(has.begin(), has.end(), false), " of ", has.size(),
           " are missing); write it for the whole mesh, or choose another one");
    return nodal ? values : values_of_tets(mesh, std::move(values), wanted.n_components, path_);
  }

 private:
  struct Section {
    std::size_t begin = 0;  // of the values, in the file
    std::size_t n = 0;      // rows
    int step = 0;           // gmsh's number of the step
    double time = 0;
  };

  static bool has_several_steps(const std::vector<Section>& sections) {
    return std::ranges::any_of(sections,
                               [&](const Section& s) { return s.step != sections[0].step; });
  }

  /// Views of several steps have the times of the first of them.
  void check_times(std::size_t field, int step, double listed) const {
    const std::vector<Section>& sections = sections_[field];
    if (!has_several_steps(sections)) return;
    for (const Section& section : sections)
      if (section.step == step && section.time != listed)
        fail(ErrorCode::bad_value, path_, ": variable '", fields_[field].name, "' has the time ",
             section.time, " at gmsh's step ", step, ", where another view has ", listed,
             "; write views of different times to files of their own");
  }

  /// The numbers of the steps at which a field has values, as they are counted in the file.
  [[nodiscard]] std::string steps_of(std::size_t field) const {
    std::string out;
    std::size_t step = 0;
    for (const auto& [tag, time] : time_of_) {
      const auto is_of_step = [&](const Section& section) { return section.step == tag; };
      if (std::ranges::any_of(sections_[field], is_of_step))
        out += (out.empty() ? "" : ", ") + std::to_string(step);
      ++step;
    }
    return out;
  }

  /// Reads the tags of a section, and skips its values.
  void list(GmshScanner& file, FieldPlace place) {
    std::string name = "unnamed";
    const std::size_t n_names =
        file.checked_count(file.number_as_text<std::uint32_t>(), "names", 2);
    for (std::size_t i = 0; i < n_names; ++i) {
      const std::string_view text = file.quoted();
      if (i == 0) name = clean_name(text);
    }
    double time = 0;
    const auto n_times = file.number_as_text<std::uint32_t>();
    for (std::uint32_t i = 0; i < n_times; ++i) {
      const auto real = file.number_as_text<double>();
      if (i == 0) time = real;
    }
    std::array<int, 3> tags{};  // step, components, rows
    const auto n_tags = file.number_as_text<std::uint32_t>();
    if (n_tags < 3) file.damaged("a section of '", name, "' with ", n_tags, " integer tags");
    for (std::uint32_t i = 0; i < n_tags; ++i) {
      const int tag = file.number_as_text<int>();
      if (i < 3) tags[i] = tag;
    }
    const auto [step, n_components, n] = tags;
    if (n_components < 1 || n_components > 9)
      file.damaged("'", name, "' has ", n_components, " components");
    if (binary_) file.end_of_line();
    file.set_binary(binary_);
    const auto each = static_cast<std::size_t>(n_components);
    const std::size_t n_rows = file.checked_count(n, "rows", 4 + 8 * each);
    const std::size_t begin = file.at();
    if (binary_) {
      file.skip<char>(n_rows * (4 + 8 * each));
      file.set_binary(false);
      file.close(end_of(place));
    } else {
      file.skip_to(end_of(place));
    }
    std::size_t field = 0;
    while (field < fields_.size() && (fields_[field].name != name || fields_[field].place != place))
      ++field;
    if (field == fields_.size()) {
      fields_.push_back({name, place, each});
      sections_.emplace_back();
    }
    if (fields_[field].n_components != each)
      file.damaged("'", name, "' has ", fields_[field].n_components, " components and ", each);
    sections_[field].push_back({begin, n_rows, step, time});
  }
  static const char* end_of(FieldPlace place) {
    return place == FieldPlace::vertices ? "$EndNodeData" : "$EndElementData";
  }

  /// Partitioned files may hold a row several times, with the same values.
  void read(GmshScanner& file, const Section& section, const FileField& field,
            const GmshTagMap& places, std::vector<double>& values, std::vector<bool>& has) const {
    const bool nodal = field.place == FieldPlace::vertices;
    file.move_to(section.begin);
    file.set_binary(binary_);
    for (std::size_t i = 0; i < section.n; ++i) {
      const std::int64_t tag = binary_ ? file.number<int>() : file.number<std::int64_t>();
      const VertexId place = tag < 0 ? -1 : places.find(static_cast<std::uint64_t>(tag));
      if (place < 0) {
        if (nodal)
          fail(ErrorCode::bad_value, path_, ": variable '", field.name, "' has a value for node ",
               tag, ", which the file does not have");
        file.skip<double>(field.n_components);  // an element that is no cell
        continue;
      }
      const auto row = static_cast<std::size_t>(place);
      for (std::size_t c = 0; c < field.n_components; ++c) {
        double& value = values[row * field.n_components + c];
        const double read = file.number<double>();
        if (has[row] && read != value && !(std::isnan(read) && std::isnan(value)))
          fail(ErrorCode::bad_value, path_, ": variable '", field.name, "' has two values for ",
               nodal ? "node " : "element ", tag, " at one step, ", value, " and ", read,
               "; write each once, and give views different names");
        value = read;
      }
      has[row] = true;
    }
    if (!binary_) file.close(end_of(field.place));  // otherwise it has more rows than announced
  }

  const std::string& path_;
  std::string_view bytes_;
  bool binary_ = false;
  std::vector<std::vector<Section>> sections_;  // per field
  std::map<int, double> time_of_;               // per step, by gmsh's number
};

}  // namespace

std::unique_ptr<FieldReader> gmsh_fields(const std::string& path, std::string_view bytes) {
  return std::make_unique<GmshFields>(path, bytes);
}

}  // namespace tess::m2m
