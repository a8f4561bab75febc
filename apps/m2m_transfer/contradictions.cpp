#include "apps/m2m_transfer/contradictions.hpp"

#include "apps/m2m_transfer/input/lists.hpp"
#include "apps/m2m_transfer/study/study.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"

#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {
namespace {

using Names = std::initializer_list<const char*>;

/// The options of a graph of meshes that moves.
constexpr Names of_graphs{"MORE", "--pairs", "--move", "--steps"};
/// The options that say how values follow from the source.
constexpr Names of_searches{"--kind", "--tolerance", "--clamp"};
constexpr Names result_files{"--out", "--picture"};
constexpr Names of_files{"--step", "--weights", "--from-weights"};

/// Results are listed and written by name.
void refuse_twice(const std::vector<std::string>& fields) {
  std::set<std::string> names;
  for (const std::string& name : split_names(fields))
    if (!names.insert(name).second)
      fail(ErrorCode::bad_argument, "--fields: ", name, " is given twice; give it once");
}

}  // namespace

void refuse_contradictions(const DriverOptions& o, Mode mode) {
  const Request& r = o.request;
  refuse_twice(r.fields);
  const auto refuse = [&](const std::string& other, std::initializer_list<Names> unused) {
    if (o.line == nullptr) return;
    for (const Names& names : unused) o.line->refuse_beside(other, names);
  };
  const auto refuse_all_kinds = [&](const char* other) {
    if (r.kind == "all") tess::refuse_together("--kind all", other);
  };
  const auto refuse_policies = [&](const char* other) {
    if (o.policies.size() > 1) tess::refuse_together("a second --policy", other);
  };
  switch (mode) {
    case Mode::stability: {
      refuse("--stability",
             {{"--study", "--round-trips", "--plot", "--explain", "--repeat"}, of_searches});
      refuse("--stability", {of_graphs, result_files, of_files});
      const char* const own = "--stability, whose cases have fields, parts and voxels of their own";
      refuse(own, {{"--fields", "--chares", "--per-pe", "--voxel"}});
      refuse_policies(own);
      return;
    }
    case Mode::round_trips:
      refuse("--round-trips", {{"--study", "--explain", "--repeat"}});
      refuse("--round-trips, which goes between two meshes that stand still",
             {of_graphs, result_files, of_files});
      return;
    case Mode::files: {
      const char* const files = "fields and weights of files";
      refuse(files, {{"--study", "--picture", "--plot", "--explain", "--repeat"}});
      refuse_all_kinds(files);
      refuse_policies(files);
      refuse(
          "fields and weights of files, which go from SOURCE to TARGET once (--step chooses the "
          "steps of a file)",
          {of_graphs});
      if (!o.from_weights.empty())
        refuse("--from-weights, which applies a matrix without a search",
               {of_searches, {"--partition", "--chares", "--per-pe", "--voxel"}});
      return;
    }
    case Mode::study:
      refuse("--study", {of_graphs, result_files});
      if (o.study == "steps") {
        refuse_all_kinds("--study steps");
        refuse("--study steps", {{"--explain"}});
        refuse_policies("--study steps");
      }
      return;
    case Mode::transfer:
      if (!o.plot.empty())
        fail(ErrorCode::bad_argument, "--plot ", o.plot,
             " is the folder of --study and --round-trips; give one of them, or --picture");
      if (!r.moves.empty() && r.steps == 1)
        fail(ErrorCode::bad_argument, "--move ", r.moves.front(),
             " moves a mesh before every step but the first, and there is one; give --steps");
      if (r.kind == "all") refuse("--kind all, which has several results", {result_files});
  }
}

kit::FileNames file_names(const DriverOptions& o, const std::string& trace) {
  kit::FileNames names;
  for (const std::string& mesh : o.request.more) names.reads("a mesh", mesh);
  for (const std::string& mesh : expand(o.request.source)) names.reads("SOURCE", mesh);
  for (const std::string& mesh : expand(o.request.target)) names.reads("TARGET", mesh);
  names.reads("--from-weights", o.from_weights);
  for (const auto& [option, path] : {std::pair<const char*, std::string>{"--out", o.out},
                                     {"--picture", o.picture},
                                     {"--json", o.json},
                                     {"--weights", o.weights},
                                     {"--trace", trace}})
    names.writes(option, path);
  return names;
}

}  // namespace m2m_transfer
