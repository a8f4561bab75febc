#include "apps/kit/driver.hpp"

#include "apps/kit/output/chart.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"
#include "runtime/version.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstdio>
#include <string_view>

namespace kit {

Json document(const std::string& program, const std::string& machine, const Json& options,
              const Json& results, const Json& more) {
  const tess::Build& build = tess::build();
  Json out{{"program", program},         {"version", build.version}, {"commit", build.commit},
           {"compiler", build.compiler}, {"mpi", build.mpi},         {"machine", machine},
           {"options", options},         {"results", results}};
  out.update(more);
  return out;
}

Driver::Driver(tess::Setup& setup, const std::string& description)
    : line_(description),
      machine_(setup.machine->describe()),
      trace_(setup.options.trace),
      speaks_(setup.machine->process() == tess::ProcessId{0}) {}

void Driver::remember(const std::string& name) {
  known_.push_back({name.substr(0, name.find_first_of(" ,")), modes_});
}

tess::Option Driver::flag(const std::string& name, bool& value, const std::string& meaning) {
  remember(name);
  return line_.flag(name, value, meaning);
}

void Driver::folder(const std::string& name, std::string& path, const std::string& meaning) {
  option(name, path, meaning);
  folders_.push_back(known_.back().name);
}

void Driver::enters(const std::string& option, Modes mode, const std::string& value) {
  mode_options_.push_back({option, value, mode});
}

void Driver::study(const std::string& meaning) {
  line_.flag("--study", is_study_, meaning);
  enters("--study", Mode::study);
}

void Driver::stability(const std::string& meaning) {
  line_.flag("--stability", is_stability_, meaning + "; exit code 1 if one fails");
  enters("--stability", Mode::stability);
}

void Driver::explain(const std::string& meaning) {
  flag("--explain", explains_, meaning);
}

void Driver::repeat(std::int32_t& n, const std::string& meaning) {
  option("--repeat", n, meaning).between(1, 1'000'000);
}

void Driver::json(const std::string& meaning) {
  line_.option("--json FILE", json_, meaning);
}

void Driver::picture(const std::string& meaning) {
  option("--plot FILE", picture_, meaning + ": FILE.svg");
}

bool Driver::parse(int argc, char** argv) {
  const std::string_view path = argv[0];
  program_ = path.substr(path.rfind('/') + 1);
  line_.option("--progress WHEN", shows_progress_, "a line that reports progress: auto, off")
      .one_of({"auto", "off"});
  if (!line_.parse(argc, argv)) return false;
  mode_ = Mode::run;
  std::string reason;
  for (const ModeOption& one : mode_options_) {
    const auto& [option, value, mode] = one;
    if (!line_.is_given(option) || (!value.empty() && line_.value(option) != value)) continue;
    if (mode_ != Mode::run && mode_ != mode && !reason.starts_with(option))
      tess::refuse_together(reason, option);
    mode_ = mode;
    reason = value.empty() ? option : option + ' ' + value;
  }
  refuse_others(reason);
  for (const std::string& name : folders_) make_folder(name, line_.value(name));
  require_writable("--json", json_);
  require_picture("--plot", picture_);
  files_.writes("--trace", trace_);
  files_.writes("--json", json_);
  files_.writes_picture("--plot", picture_);
  progress_.emplace(speaks_ && shows_progress_ == "auto" ? stderr : nullptr);
  return true;
}

void Driver::enter(Modes mode, const std::string& reason) {
  mode_ = mode;
  refuse_others(reason);
}

void Driver::refuse_others(const std::string& reason) const {
  for (const Known& known : known_) {
    if ((known.modes & mode_) != 0 || !line_.is_given(known.name)) continue;
    if (mode_ != Mode::run) line_.refuse_beside(reason, {known.name.c_str()});
    std::string needed;
    for (const auto& [option, value, mode] : mode_options_)
      if ((known.modes & mode) != 0 && needed.find(option) == std::string::npos)
        needed += (needed.empty() ? "" : " or ") + option + (value.empty() ? "" : " ") + value;
    line_.refuse_without(needed, {known.name.c_str()});
  }
}

void Driver::refuse_both(const char* option, const char* other) const {
  if (!line_.is_given(other)) return;
  const std::string value = line_.value(other);
  line_.refuse_beside(value.empty() ? other : std::string(other) + ' ' + value, {option});
}

Json Driver::document(const Json& results, const Json& more) const {
  Json options;
  options.update(Json());  // an object, also without members
  for (const Known& known : known_)
    if ((known.modes & mode_) != 0)
      options[known.name.substr(known.name.find_first_not_of('-'))] = line_.value(known.name);
  return kit::document(program_, machine_, options, results, more);
}

void Driver::write(const Json& results, const Json& more) const {
  if (!json_.empty()) write_file(json_, json_text(document(results, more)));
}

void Driver::draw(const Chart& chart) const {
  if (!picture_.empty()) (void)write_svg(picture_, chart);
}

}  // namespace kit
