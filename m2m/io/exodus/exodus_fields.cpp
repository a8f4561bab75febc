#include "m2m/io/exodus/exodus_elements.hpp"
#include "m2m/io/exodus/exodus_file.hpp"
#include "m2m/io/exodus/exodus_turn.hpp"
#include "m2m/io/field_reader.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/core.h>
#include <optional>
#include <utility>

namespace tess::m2m {
namespace {

/// Nodal and element variables. A variable is a scalar. NAME_x, NAME_y and NAME_z in a row, and the
/// like, are also one field of three components, NAME, as ParaView shows them.
class ExodusFields : public FieldReader, private ExodusFile {
 public:
  ExodusFields(const std::string& path, std::string_view bytes) : ExodusFile(path, bytes) {
    const ExodusTurn turn;
    set_name_length();
    const auto n_steps = static_cast<std::size_t>(count(EX_INQ_TIME, "number of time steps"));
    times_.resize(n_steps);
    check_lengths("time_whole", {static_cast<std::int64_t>(n_steps)});
    if (n_steps > 0) check(ex_get_all_times(id_, times_.data()), "ex_get_all_times");
    add_fields(FieldPlace::vertices);
    add_fields(FieldPlace::tets);
  }

  [[nodiscard]] std::vector<double> read(const TetMesh& mesh, std::size_t field,
                                         std::size_t step) const override {
    const ExodusTurn turn;
    const bool nodal = fields_[field].place == FieldPlace::vertices;
    const std::vector<int>& variables = variables_[field];
    const std::size_t n_components = variables.size();
    std::vector<double> values;
    for (std::size_t c = 0; c < n_components; ++c) {
      const std::vector<double> column = nodal ? at_vertices(mesh, field, variables[c], step)
                                               : in_elements(mesh, field, variables[c], step);
      values.resize(column.size() * n_components);
      for (std::size_t i = 0; i < column.size(); ++i) values[i * n_components + c] = column[i];
    }
    return nodal ? values : values_of_tets(mesh, std::move(values), n_components, path_);
  }

 private:
  static constexpr ex_entity_type type_of(FieldPlace place) {
    return place == FieldPlace::vertices ? EX_NODAL : EX_ELEM_BLOCK;
  }

  void add_fields(FieldPlace place) {
    int n = 0;
    check(ex_get_variable_param(id_, type_of(place), &n), "ex_get_variable_param");
    if (n < 0 || n > most()) damaged("number of variables", -1);
    std::vector<std::string> names;
    for (int i = 1; i <= n; ++i) {
      std::array<char, 512> name{};
      check(ex_get_variable_name(id_, type_of(place), i, name.data()), "ex_get_variable_name");
      names.push_back(clean_name(name.data()));
    }
    for (int i = 0; i < n; ++i) {
      if (const auto stem = vector_at(names, i)) {
        add({*stem, place, 3}, {i + 1, i + 2, i + 3});
        for (int c = i; c < i + 3; ++c) add({names[at(c)], place, 1, true}, {c + 1});
        i += 2;
      } else {
        add({names[at(i)], place}, {i + 1});
      }
    }
  }
  void add(FileField field, std::vector<int> variables) {
    fields_.push_back(std::move(field));
    variables_.push_back(std::move(variables));
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// The name of the vector of which this variable and the next two are the components: they differ
  /// in an x, y, z at the end or the beginning, as VELOCITY_X, velocityx and xvelocity do.
  static std::optional<std::string> vector_at(const std::vector<std::string>& names, int first) {
    if (at(first) + 3 > names.size()) return std::nullopt;
    for (const bool at_end : {true, false}) {
      const auto stem_of = [&](int c) -> std::optional<std::string> {
        std::string name = names[at(first + c)];
        if (!at_end) std::ranges::reverse(name);
        if (name.empty() || std::tolower(static_cast<unsigned char>(name.back())) != "xyz"[c])
          return std::nullopt;
        name.pop_back();
        if (name.ends_with('_')) name.pop_back();
        if (!at_end) std::ranges::reverse(name);
        return name;
      };
      const auto x = stem_of(0), y = stem_of(1), z = stem_of(2);
      const bool agree = x && x == y && y == z && !x->empty();
      if (agree && std::ranges::find(names, *x) == names.end()) return x;
    }
    return std::nullopt;
  }

  /// Reads the n values of a variable in a block, or at all nodes.
  void read_values(std::size_t field, int variable, std::size_t step, std::int64_t block,
                   std::int64_t n, double* values) const {
    const ex_entity_type type = type_of(fields_[field].place);
    const int code = ex_get_var(id_, static_cast<int>(step + 1), type, variable, block, n, values);
    if (code > 0)  // a warning
      fail(ErrorCode::bad_value, path_, ": variable '", fields_[field].name,
           "' has a name, but no values; write them, or choose another one");
    check(code, "ex_get_var");
  }

  [[nodiscard]] std::vector<double> at_vertices(const TetMesh& mesh, std::size_t field,
                                                int variable, std::size_t step) const {
    const std::int64_t n = count(EX_INQ_NODES, "number of nodes");
    check_n_points(mesh, n, path_);
    std::vector<double> values(static_cast<std::size_t>(n));
    check_shape(fmt::format("vals_nod_var{}", variable), n);
    if (n > 0) read_values(field, variable, step, 1, n, values.data());
    return values;
  }

  /// Per element of the dimension of the mesh.
  [[nodiscard]] std::vector<double> in_elements(const TetMesh& mesh, std::size_t field,
                                                int variable, std::size_t step) const {
    const std::int64_t n_blocks = count(EX_INQ_ELEM_BLK, "number of blocks");
    int n_variables = 0;
    check(ex_get_variable_param(id_, EX_ELEM_BLOCK, &n_variables), "ex_get_variable_param");
    if (n_variables < variable || n_variables > most() / std::max<std::int64_t>(n_blocks, 1))
      damaged("number of variables", -1);
    std::vector<int> has(static_cast<std::size_t>(n_blocks) * at(n_variables));
    check_lengths("elem_var_tab", {n_blocks, n_variables});
    if (!has.empty())
      check(ex_get_truth_table(id_, EX_ELEM_BLOCK, static_cast<int>(n_blocks), n_variables,
                               has.data()),
            "ex_get_truth_table");
    std::vector<double> values;
    std::size_t row = 0;
    for (const std::int64_t id : ids_of(EX_ELEM_BLOCK, n_blocks)) {
      const ElementBlock block = block_of(id, row + 1);
      const bool is_there = has[row++ * at(n_variables) + at(variable - 1)] != 0;
      if (block.n_elements == 0 || exodus_dimension(block.type) != mesh.dimension) continue;
      if (block.n_elements < 0 || block.n_elements > most()) damaged("number of elements", -1);
      if (!is_there)
        fail(ErrorCode::bad_value, path_, ": variable '", fields_[field].name,
             "' is missing in block ", id, "; write it for all blocks, or choose another one");
      check_shape(fmt::format("vals_elem_var{}eb{}", variable, row), block.n_elements);
      const std::size_t first = values.size();
      values.resize(first + static_cast<std::size_t>(block.n_elements));
      read_values(field, variable, step, id, block.n_elements, values.data() + first);
    }
    return values;
  }

  std::vector<std::vector<int>> variables_;  // per field, from 1 on
};

}  // namespace

std::unique_ptr<FieldReader> exodus_fields(const std::string& path, std::string_view bytes) {
  return std::make_unique<ExodusFields>(path, bytes);
}

}  // namespace tess::m2m
