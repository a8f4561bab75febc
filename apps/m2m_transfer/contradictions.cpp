#include "apps/m2m_transfer/contradictions.hpp"

#include "apps/command_line.hpp"
#include "apps/m2m_transfer/input/lists.hpp"
#include "apps/m2m_transfer/study/study.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {
namespace {

/// An option as it was given, "--steps 5"; empty: it was not given.
using Given = std::string;

Given given(const char* option, const std::string& value) {
  return value.empty() ? Given() : text(option, " ", value);
}

void refuse(const std::string& mode, const std::vector<Given>& unused) {
  for (const Given& option : unused)
    if (!option.empty()) apps::refuse_together(option, mode);
}

/// The options of a graph of meshes that moves.
std::vector<Given> graph_options(const Request& r) {
  return {given("mesh", r.more.empty() ? std::string() : r.more.front()), given("--pairs", r.pairs),
          given("--move", r.moves.empty() ? std::string() : r.moves.front()),
          r.steps == 1 ? Given() : text("--steps ", r.steps)};
}

/// The options that say how values follow from the source.
std::vector<Given> search_options(const DriverOptions& o) {
  const Request& r = o.request;
  return {o.kind_is_given ? "--kind " + r.kind : "",
          r.tolerance != 0 ? text("--tolerance ", r.tolerance) : Given(), r.clamp ? "--clamp" : ""};
}

std::vector<Given> result_files(const DriverOptions& o) {
  return {given("--out", o.out), given("--picture", o.picture)};
}

/// Results are listed and written by name.
void refuse_twice(const std::vector<std::string>& fields) {
  std::set<std::string> names;
  for (const std::string& name : split_names(fields))
    if (!names.insert(name).second)
      fail(ErrorCode::bad_argument, "--fields: ", name, " is given twice; give it once");
}

std::vector<Given> joined(std::vector<Given> a, const std::vector<Given>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

void refuse_contradictions(const DriverOptions& o, Mode mode) {
  const Request& r = o.request;
  refuse_twice(r.fields);
  const Given repeat = o.repeat ? text("--repeat ", *o.repeat) : Given();
  const Given explain = o.explain ? "--explain" : "";
  const std::vector<Given> of_files{given("--step", o.step), given("--weights", o.weights),
                                    given("--from-weights", o.from_weights)};
  switch (mode) {
    case Mode::stability:
      refuse("--stability", joined({o.study ? "--study" : "", given("--round-trips", o.round_trips),
                                    given("--plot", o.plot), explain, repeat},
                                   search_options(o)));
      refuse("--stability", joined(joined(graph_options(r), result_files(o)), of_files));
      refuse("--stability, whose cases have fields, parts and voxels of their own",
             {o.fields_are_given ? "--fields " + r.fields.front() : "",
              o.chares_are_given ? "--chares or --per-pe" : "",
              r.voxel > 0 ? text("--voxel ", r.voxel) : Given(),
              o.policies.size() > 1 ? "a second --policy" : ""});
      return;
    case Mode::round_trips:
      refuse("--round-trips", {o.study ? "--study" : "", explain, repeat});
      refuse("--round-trips, which goes between two meshes that stand still",
             joined(joined(graph_options(r), result_files(o)), of_files));
      return;
    case Mode::files:
      refuse("fields and weights of files",
             {o.study ? "--study" : "", given("--picture", o.picture), given("--plot", o.plot),
              explain, repeat, r.kind == "all" ? "--kind all" : "",
              o.policies.size() > 1 ? "a second --policy" : ""});
      refuse(
          "fields and weights of files, which go from SOURCE to TARGET once (--step chooses the "
          "steps of a file)",
          graph_options(r));
      if (!o.from_weights.empty())
        refuse("--from-weights, which applies a matrix without a search",
               joined(search_options(o), {o.partition_is_given ? "--partition " + r.partition : "",
                                          o.chares_are_given ? "--chares or --per-pe" : "",
                                          r.voxel > 0 ? text("--voxel ", r.voxel) : Given()}));
      return;
    case Mode::study:
      refuse("--study", joined(graph_options(r), result_files(o)));
      if (o.study == "steps")
        refuse("--study steps", {r.kind == "all" ? "--kind all" : "", explain,
                                 o.policies.size() > 1 ? "a second --policy" : ""});
      return;
    case Mode::transfer:
      if (!o.plot.empty())
        fail(ErrorCode::bad_argument, "--plot ", o.plot,
             " is the folder of --study and --round-trips; give one of them, or --picture");
      if (!r.moves.empty() && r.steps == 1)
        fail(ErrorCode::bad_argument, "--move ", r.moves.front(),
             " moves a mesh before every step but the first, and there is one; give --steps");
      if (r.kind == "all") refuse("--kind all, which has several results", result_files(o));
  }
}

plot::FileNames file_names(const DriverOptions& o, const std::string& trace) {
  plot::FileNames names;
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
