#include "apps/m2m_transfer/file_fields.hpp"

#include "apps/kit/output/write_file.hpp"
#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/input/part.hpp"
#include "apps/m2m_transfer/output/found.hpp"
#include "apps/m2m_transfer/result_format.hpp"
#include "m2m/cell_transfer.hpp"
#include "m2m/count_nan.hpp"
#include "m2m/coupling_weights.hpp"
#include "m2m/field_file.hpp"
#include "m2m/transfer.hpp"
#include "m2m/weights_file.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <optional>

namespace m2m_transfer {
namespace {

/// Values per vertex in one batch; a batch has at least one step.
constexpr std::size_t batch_components = 64;

/// Where the file has the field; at vertices if it has two of the name.
std::optional<FieldPlace> place_of(const FieldFile& file, const std::string& name) {
  for (const FieldPlace place : {FieldPlace::vertices, FieldPlace::tets})
    if (std::ranges::any_of(file.fields(), [&](const FileField& field) {
          return field.place == place && field.name == name;
        }))
      return place;
  return std::nullopt;
}

bool is_formula(const std::string& name) {
  try {
    (void)make_formula(name, {{0, 0, 0}, {1, 1, 1}});
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The fields of the source, read or sampled one step at a time.
class SourceFields {
 public:
  SourceFields(const FileFieldsRequest& request, const ReadPart& source)
      : source_(source), names_(split_names(request.fields)) {
    if (!request.source.starts_with("kuhn:")) file_.emplace(request.source);
    bool from_file = false;
    for (const std::string& name : names_) {
      const std::optional<FieldPlace> place = file_ ? place_of(*file_, name) : std::nullopt;
      from_file = from_file || place;
      places_.push_back(place.value_or(FieldPlace::vertices));
      formulas_.push_back(place ? std::nullopt : formula_of(name));
    }
    if (from_file)
      choose_steps(request.step);
    else if (!request.step.empty())
      fail(ErrorCode::bad_argument, "--step ", request.step, " chooses a step of a field of ",
           request.source, ", but --fields names none; name one");
    else
      steps_ = {0};
  }

  [[nodiscard]] const std::vector<std::size_t>& steps() const { return steps_; }
  [[nodiscard]] double time_of(std::size_t step) const {
    return file_ && step < file_->n_steps() ? file_->times()[step] : 0;
  }
  /// Those at vertices, formulas among them, or those in elements; in the order of their names.
  [[nodiscard]] std::vector<Field> at(std::size_t step, FieldPlace place) const {
    std::vector<Field> fields;
    for (std::size_t f = 0; f < names_.size(); ++f) {
      if (places_[f] != place) continue;
      fields.push_back(formulas_[f] ? sample(source_.mesh(), names_[f], *formulas_[f])
                                    : from_file(names_[f], place, step));
    }
    return fields;
  }
  [[nodiscard]] bool has(FieldPlace place) const {
    return std::ranges::find(places_, place) != places_.end();
  }

 private:
  [[nodiscard]] Field from_file(const std::string& name, FieldPlace place, std::size_t step) const {
    const std::optional<SurfaceMesh>& part = source_.part;
    if (place == FieldPlace::vertices) {
      Field field = file_->vertex_field(source_.whole, name, step);
      return part ? rows_of(field, part->vertex_of_point) : field;
    }
    Field field = file_->tet_field(source_.whole, name, step);
    return part ? rows_of(field, part->tet_of_cell) : field;
  }
  /// A name that is neither is refused with what the file has.
  [[nodiscard]] std::optional<Formula> formula_of(const std::string& name) const {
    if (!is_formula(name) && file_ && !file_->fields().empty())
      (void)file_->vertex_field(source_.whole, name, 0);
    return make_formula(name, bounds(source_.mesh()));
  }
  void choose_steps(const std::string& text) {
    const std::size_t n = file_->n_steps();
    if (text == "all") {
      for (std::size_t step = 0; step < n; ++step) steps_.push_back(step);
      if (n > 0) return;
    }
    const std::size_t last = n == 0 ? 0 : n - 1;
    const auto step = text.empty() || text == "all" ? last : parse_number<std::size_t>(text);
    if (!step)
      fail(ErrorCode::bad_argument, "--step ", text,
           " is no step; give a number from 0 on, or all");
    steps_ = {*step};
  }

  const ReadPart& source_;
  std::vector<std::string> names_;
  std::optional<FieldFile> file_;
  std::vector<FieldPlace> places_;
  std::vector<std::optional<Formula>> formulas_;  // none: from the file
  std::vector<std::size_t> steps_;
};

/// Fields of some steps as one list: those of the first step, then those of the second, …
struct FieldsOfSteps {
  std::vector<Field> fields{};
  std::size_t n_each = 0;  // per step
  /// Returns the components that a step adds.
  std::size_t add(std::vector<Field> more) {
    n_each = more.size();
    std::size_t n_components = 0;
    for (Field& field : more) {
      n_components += field.n_components;
      fields.push_back(std::move(field));
    }
    return n_components;
  }
  [[nodiscard]] std::vector<Field> of_step(const std::vector<Field>& all, std::size_t k) const {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(k * n_each);
    return {first, first + static_cast<std::ptrdiff_t>(n_each)};
  }
};

/// The motions of the source, and the vectors that turn with it.
class SourceMotion {
 public:
  SourceMotion(const FileFieldsRequest& request, const TetMesh& source)
      : vectors_(split_names(request.vectors)) {
    const std::vector<std::string> fields = split_names(request.fields);
    for (const std::string& name : vectors_)
      if (std::ranges::find(fields, name) == fields.end())
        fail(ErrorCode::bad_argument, "--vector ", name, " is no field of --fields; name it there");
    for (const std::string& text : request.moves) {
      each_.push_back(parse_motion(text, {request.source, request.target}, 1));
      if (each_.back().mesh != 0)
        fail(
            ErrorCode::bad_argument, "--move: '", text,
            "' moves the target, which stays with fields of files; move the source: A:rotate(…) or "
            "A:translate(…)");
      set_centre(each_.back(), bounds(source));
    }
  }
  [[nodiscard]] bool is_none() const { return each_.empty(); }
  void move(TetMesh& source) {
    for (const StepMotion& step : std::vector(each_)) {
      const RigidMotion& motion = made_.emplace_back(step.motion);
      move_points(source.points, motion);
      move_centres(each_, motion);
    }
  }
  /// Turns the vectors among the fields into the frame of the target.
  void turn(std::vector<Field>& fields) const {
    for (Field& field : fields) {
      if (std::ranges::find(vectors_, field.name) == vectors_.end()) continue;
      if (field.n_components != 3)
        fail(ErrorCode::bad_argument, "--vector ", field.name, ": the field has ",
             field.n_components, field.n_components == 1 ? " component" : " components",
             ", and a vector has 3; leave it out");
      for (const RigidMotion& motion : made_) turn_vectors(field.values, motion);
    }
  }

 private:
  std::vector<std::string> vectors_;
  std::vector<StepMotion> each_;  // before every step but the first
  std::vector<RigidMotion> made_;
};

struct Batch {
  std::vector<std::size_t> steps{};
  FieldsOfSteps vertices{}, cells{};
};

/// The target vertices: what they have before the transfer, and what they get.
std::vector<Field> start_values(const std::vector<Field>& fields, std::size_t n_points) {
  std::vector<Field> out;
  for (const Field& field : fields)
    out.push_back(
        {field.name, field.n_components, std::vector<double>(n_points * field.n_components, 0.0)});
  return out;
}

/// Writes a step after the other.
class ResultFile {
 public:
  ResultFile(const std::string& path, const TetMesh& mesh) : path_(path), mesh_(mesh) {
    if (is_pvd(path))
      series_.emplace(path);
    else if (!path.empty() && !is_vtu(path))
      steps_.emplace(path, mesh);
  }
  void add(double time, std::span<const Field> fields, std::span<const Field> cells) {
    if (steps_)
      steps_->add(time, fields, cells);
    else if (series_)
      series_->add(time, mesh_, fields, cells);
    else if (!path_.empty())
      write_vtu(path_, mesh_, fields, cells, time);
  }
  void finish() {
    if (steps_) steps_->finish();
  }

 private:
  const std::string& path_;
  const TetMesh& mesh_;
  std::optional<ExodusSteps> steps_;
  std::optional<PvdSeries> series_;
};

struct Run {
  const FileFieldsRequest& request;
  const TetMesh &source, &target;
  TransferOptions options{};
  WeightMatrix matrix{};
};

/// The fields of a batch at the points of a target, before and after a transfer.
struct Arrival {
  const TetMesh& mesh;
  std::vector<Field> values{};
  std::vector<Status> status{};  // after a search
};

/// A search and one application of all fields. Gives what was found, and the weights if `matrix` is
/// not null.
TaskOf<SearchSummary> transfer_to(const Run& run, DistributedMesh source, Arrival& to,
                                  std::int32_t n_parts, WeightMatrix* matrix) {
  DistributedMesh target;
  co_await epoch([&] {
    target = scatter(to.mesh, to.values, n_parts, parse_partition_method(run.request.partition),
                     target_halo_layers(run.options.kind));
  });
  Transfer transfer(source, target, run.options);
  const SearchSummary found = co_await transfer.search();
  if (matrix != nullptr)
    *matrix = co_await collect_weights(transfer, static_cast<std::int64_t>(run.source.n_points()),
                                       static_cast<std::int64_t>(to.mesh.n_points()));
  co_await transfer.apply();
  const Outcome all = co_await target.workers.reduce<&Worker::gather>();
  to.status.resize(to.mesh.n_points());
  const double* row = all.values.data();
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(all.points[i]);
    to.status[vertex] = all.status[i];
    for (Field& field : to.values) {
      std::copy_n(row, field.n_components, field.values.data() + vertex * field.n_components);
      row += field.n_components;
    }
  }
  co_await epoch([&] { transfer.destroy(); });
  co_await epoch([&] { target.destroy(); });
  co_return found;
}

/// Moves a batch to the target and to the points that are watched.
Task transfer_batch(Run& run, const Batch& batch, Arrival& target, Arrival& watched,
                    FileFieldsReport& report) {
  const FileFieldsRequest& request = run.request;
  DistributedMesh source;
  co_await epoch([&] {
    source =
        scatter(run.source, batch.vertices.fields, request.chares(),
                parse_partition_method(request.partition), source_halo_layers(run.options.kind));
  });
  const bool is_first = !std::exchange(report.searched, true);
  const bool has_weights = is_first && !request.weights.empty();
  const SearchSummary found = co_await transfer_to(run, source, target, request.chares(),
                                                   has_weights ? &run.matrix : nullptr);
  if (is_first) {
    report.tally = found.tally;
    report.worst = found.worst;
  }
  if (!request.watch.empty()) co_await transfer_to(run, source, watched, 1, nullptr);
  co_await epoch([&] { source.destroy(); });
}

/// The same by weights, on this PE.
void apply_batch(const Run& run, const Batch& batch, std::vector<Field>& values) {
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (const auto* given = std::get_if<UseValue>(&run.options.policy))
      std::ranges::fill(values[f].values, given->value);
    apply(run.matrix, batch.vertices.fields[f].values, values[f].n_components, values[f].values);
  }
}

/// A search and one application of all fields in elements.
TaskOf<CellOutcome> transfer_cell_batch(const Run& run, const Batch& batch) {
  return transfer_cells(run.source, batch.cells.fields, run.target, run.request.chares(),
                        parse_partition_method(run.request.partition), run.options);
}

void name_fields(const Batch& batch, FileFieldsReport& report) {
  const auto add = [&](const FieldsOfSteps& some, const char* place) {
    for (std::size_t f = 0; f < some.n_each; ++f) {
      const Field& field = some.fields[f];
      report.fields.push_back(
          field.n_components == 1
              ? field.name + place
              : fmt::format("{} ({} components){}", field.name, field.n_components, place));
    }
  };
  add(batch.vertices, "");
  add(batch.cells, " (in elements)");
}

void read_matrix(Run& run, FileFieldsReport& report) {
  const std::string& path = run.request.from_weights;
  run.matrix = read_weights(path, run.source, run.target);
  const Rows<double>& rows = run.matrix.rows;
  report.n_weights = rows.weights.size();
  for (std::size_t row = 0; row < rows.n_rows(); ++row)
    report.n_without += rows.columns_of(row).empty() ? 1U : 0U;
  if (report.n_without > 0 && std::holds_alternative<Nearest>(run.options.policy))
    fail(ErrorCode::bad_argument, path, ": ", report.n_without,
         " target vertices have no weights, and --policy nearest needs a search; write the weights "
         "with that policy, or choose keep or value:V");
}

void check_options(const FileFieldsRequest& request) {
  if (!request.watch.empty() && !request.from_weights.empty())
    tess::refuse_together("--watch", "--from-weights, which holds no weights of its points");
  if (!request.watch.empty() && is_conservative(parse_transfer_kind(request.kind)))
    fail(ErrorCode::bad_argument, "--watch takes values at points, and kind ", request.kind,
         " gives them to cells; choose another --kind");
  kit::require_writable("--watch-file", request.watch_file);
  if (!request.weights.empty()) require_weights(parse_transfer_kind(request.kind), request.clamp);
  kit::require_writable("--weights", request.weights);
  kit::require_writable("--out", request.out);
  require_result_format(request.out);
  require_names_differ(request.out, split_names(request.fields));
  if (is_pvtu(request.out))
    fail(ErrorCode::bad_argument, "--out ", request.out,
         ": fields of files are gathered on one process; give a file that ends in .exo, .vtu or "
         ".pvd");
}

/// The next steps, as many as are moved together, with at most so many components unless it is one;
/// `next` is a position in fields.steps().
Batch read_batch(const SourceFields& fields, std::size_t most_components, std::size_t& next) {
  Batch batch;
  std::size_t n_components = 0;
  do {
    const std::size_t step = fields.steps()[next++];
    batch.steps.push_back(step);
    const std::size_t each = batch.vertices.add(fields.at(step, FieldPlace::vertices)) +
                             batch.cells.add(fields.at(step, FieldPlace::tets));
    n_components += each;
    if (n_components + each > most_components) break;
  } while (next < fields.steps().size());
  return batch;
}

/// Adds fields of a result to its hash, and to the most points that got NaN in one field.
void add_result(const std::vector<Field>& fields, std::uint64_t& hash, std::size_t& n_nan) {
  for (const Field& field : fields) {
    hash = result_hash(field.values, hash);
    n_nan = std::max(n_nan, count_nan_rows(field.values, field.n_components));
  }
}

}  // namespace

bool is_for_files(const FileFieldsRequest& request) {
  if (!request.step.empty() || !request.weights.empty() || !request.from_weights.empty())
    return true;
  if (request.source.starts_with("kuhn:")) return false;
  try {
    const FieldFile file(request.source);
    for (const std::string& name : split_names(request.fields))
      if (place_of(file, name) || (!file.fields().empty() && !is_formula(name))) return true;
  } catch (const Error&) {  // the run reads the file again, and reports what is wrong
  }
  return false;
}

TaskOf<FileFieldsReport> move_file_fields(const FileFieldsRequest& request,
                                          kit::Progress& progress) {
  check_options(request);
  FileFieldsReport report;
  progress.phase("reading");
  const ReadPart source = read_part(request.source, request.source_part);
  const ReadPart target = read_part(request.target, request.target_part);
  // Fields stay as they are on the mesh at rest.
  TetMesh moving = request.moves.empty() ? TetMesh{} : source.mesh();
  Run run{request, request.moves.empty() ? source.mesh() : moving, target.mesh()};
  run.options.policy = parse_policy(request.policy);
  run.options.kind = parse_transfer_kind(request.kind);
  run.options.tolerance = request.tolerance;
  run.options.clamp = request.clamp;
  run.options.order = request.order;
  run.options.voxel_size = {request.voxel, request.voxel, request.voxel};
  const std::function<void(const char*)> on_phase = [&progress](const char* name) {
    progress.phase(name);
  };
  run.options.on_phase = &on_phase;
  report.source = run.source.name;
  report.target = run.target.name;
  const auto elements_of = [](const TetMesh& mesh) -> OtherElements {
    return {.skipped = skipped_text(mesh),
            .split = split_text(mesh),
            .unused = unused_text(n_unused(mesh), mesh.n_points())};
  };
  report.source_elements = elements_of(run.source);
  report.target_elements = elements_of(run.target);
  report.source_elements.repeated = repeated_text(run.source);
  if (report.source == report.target)
    report.source_elements.coincident = coincident_text(run.source);
  SourceMotion motion(request, run.source);
  if (motion.is_none() && request.steps > 1)
    fail(ErrorCode::bad_argument, "--steps ", request.steps,
         " applies fields of files once: add --move A:…, or leave it out");
  const SourceFields fields(request, source);
  if (is_vtu(request.out) && fields.steps().size() > 1)
    fail(ErrorCode::bad_argument, "--out ", request.out, ": VTU holds one step, and there are ",
         fields.steps().size(), "; give a file that ends in .exo or .pvd, or one --step");
  for (std::size_t k = 0; k < fields.steps().size() && is_pvd(request.out); ++k)
    for (const auto& [name, path] :
         {std::pair{"SOURCE", &request.source}, {"TARGET", &request.target}})
      if (const std::string step = PvdSeries::path_of_step(request.out, k);
          std::filesystem::exists(step) && std::filesystem::exists(*path) &&
          std::filesystem::equivalent(step, *path))
        fail(ErrorCode::bad_argument, step, ", a step of --out, would overwrite ", name,
             "; write the series elsewhere");
  if (fields.has(FieldPlace::tets) && !(request.weights + request.from_weights).empty())
    fail(ErrorCode::bad_argument,
         "weights are of values at vertices, and --fields names a field in elements; leave it out, "
         "or --weights and --from-weights");
  if (!request.from_weights.empty()) read_matrix(run, report);
  const TetMesh watched = watch_points(request.watch);
  if (fields.has(FieldPlace::tets) && !request.watch.empty())
    fail(ErrorCode::bad_argument,
         "--watch takes values at vertices, and --fields names a field in elements; leave it out");
  ResultFile out(request.out, run.target);
  for (int step = 1; step < request.steps; ++step) motion.move(moving);
  for (std::size_t next = 0; next < fields.steps().size();) {
    if (next > 0) motion.move(moving);
    Batch batch = read_batch(fields, motion.is_none() ? batch_components : 0, next);
    motion.turn(batch.vertices.fields);
    motion.turn(batch.cells.fields);
    if (report.fields.empty()) name_fields(batch, report);
    Arrival to{run.target, start_values(batch.vertices.fields, run.target.n_points())};
    Arrival there{watched, start_values(batch.vertices.fields, watched.n_points())};
    if (!request.from_weights.empty()) {
      progress.phase("apply");
      apply_batch(run, batch, to.values);
    } else if (fields.has(FieldPlace::vertices)) {
      co_await transfer_batch(run, batch, to, there, report);
    }
    CellOutcome cells;
    if (fields.has(FieldPlace::tets)) {
      cells = co_await transfer_cell_batch(run, batch);
      report.cell_tally = cells.search.tally;
      report.has_cells = true;
    }
    progress.phase("writing");
    for (std::size_t k = 0; k < batch.steps.size(); ++k) {
      std::vector<Field> result = batch.vertices.of_step(to.values, k);
      std::vector<Field> in_cells = batch.cells.of_step(cells.fields, k);
      const double time = fields.time_of(batch.steps[k]);
      MovedStep step{batch.steps[k], time, 0, 0, result_hash({})};
      add_result(result, step.result_hash, step.n_nan);
      add_result(in_cells, step.result_hash, step.n_nan_cells);
      report.steps.push_back(step);
      add_watched(report.watched, time, watched, batch.vertices.of_step(there.values, k),
                  there.status);
      if (!to.status.empty()) result.push_back(status_field(to.status, result));
      if (report.has_cells) in_cells.push_back(status_field(cells.status, in_cells));
      out.add(time, result, in_cells);
    }
  }
  out.finish();
  if (!request.watch_file.empty())
    kit::write_file(request.watch_file, watch_rows().csv(report.watched));
  if (!request.weights.empty()) {
    write_weights(request.weights, run.matrix);
    report.n_weights = run.matrix.rows.weights.size();
  }
  co_return report;
}

std::string table(const FileFieldsReport& r) {
  std::string names;
  for (const std::string& name : r.fields) names += (names.empty() ? "" : ", ") + name;
  std::string out = fmt::format("{} -> {}\n", r.source, r.target);
  const auto line = [&out](const char* title, const std::string& what) {
    if (!what.empty()) out += fmt::format("  {:<12} {}\n", title, what);
  };
  line("fields", names);
  for (const auto& [title, elements] : lines_of(r.source_elements, r.target_elements))
    line(title, elements);
  if (r.searched) line("found", found_text(r.tally.counts));
  line("overlaps", overcovered_text(r.tally));
  line("not native", linear_text(r.tally));
  if (r.has_cells) line("cells found", found_text(r.cell_tally.counts));
  line("overlaps", overcovered_text(r.cell_tally));
  for (const std::string& place : texts_of(r.worst)) line("farthest", place);
  if (r.n_weights > 0)
    line("weights",
         fmt::format(
             "{} {}", r.n_weights,
             r.searched ? "written" : fmt::format("read, {} vertices without", r.n_without)));
  for (const MovedStep& step : r.steps)
    out += fmt::format(
        "  {:<12} {:016x}{}{}\n", fmt::format("step {} at {:.6g}", step.step, step.time),
        step.result_hash, step.n_nan == 0 ? "" : fmt::format(", NaN at {} vertices", step.n_nan),
        step.n_nan_cells == 0 ? "" : fmt::format(", NaN in {} cells", step.n_nan_cells));
  if (!r.watched.empty()) out += watch_rows().table(r.watched);
  return out;
}

kit::Json json_of(const FileFieldsReport& r) {
  kit::Json whole{{"source", r.source}, {"target", r.target}, {"fields", r.fields}};
  whole["elements"] = json_of(r.source_elements, r.target_elements);
  const auto add_found = [&whole](const std::string& of, const Tally& tally) {
    constexpr const char* names[] = {"inside", "boundary", "snapped", "outside"};
    for (std::size_t i = 0; i < 4; ++i) whole[of + names[i]] = tally.counts[i];
  };
  const auto add_overlaps = [&whole](const std::string& of, const Tally& tally) {
    if (tally.n_overcovered > 0)
      whole.update(
          {{of + "overcovered", tally.n_overcovered}, {of + "most_covered", tally.most_covered}});
  };
  if (r.searched) {
    add_found("", r.tally);
    if (r.tally.n_linear > 0) whole["linear"] = r.tally.n_linear;
    whole["farthest"] = json_of(r.worst);
  } else if (!r.has_cells) {
    whole["without_weights"] = r.n_without;
  }
  if (r.has_cells) add_found("cells_", r.cell_tally);
  add_overlaps("", r.tally);
  add_overlaps("cells_", r.cell_tally);
  if (r.n_weights > 0) whole["weights"] = r.n_weights;
  whole["steps"] = kit::Json::array();
  for (const MovedStep& step : r.steps)
    whole["steps"].push_back({{"step", step.step},
                              {"time", step.time},
                              {"nan_vertices", step.n_nan},
                              {"nan_cells", step.n_nan_cells},
                              {"result_hash", kit::hex(step.result_hash)}});
  if (!r.watched.empty()) whole["watched"] = watch_rows().json(r.watched);
  return whole;
}

}  // namespace m2m_transfer
