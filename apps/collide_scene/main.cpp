// collide_scene INPUT…: finds the objects of a scene that collide, and reports pairs, candidates,
// false positives and the time per object.
#include "apps/collide_scene/driver.hpp"
#include "apps/collide_scene/input/load.hpp"
#include "apps/collide_scene/stability/report.hpp"
#include "apps/kit/file_names.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <string_view>

namespace {

/// True if the command line asks for PEs of the runtime; it removes these options later.
bool asks_for_pes(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view option(argv[i]);
    const std::string_view name = option.substr(0, option.find('='));
    if (name == "--pes" || name == "--sim") return true;
  }
  return false;
}

int run(tess::Setup& setup, int argc, char** argv, bool asked_for_pes) {
  collide_scene::Options options;
  tess::CommandLine line(
      "Finds the objects of a scene that collide. In one thread; with --pes, --sim or under mpirun "
      "on chares.");
  line.option("INPUT", options.inputs,
              "files of triangles (.obj, .ply, .stl), each a model, or scenes NAME:N (below)");
  line.option("--steps", options.steps, "steps of a scene that moves").between(1, 1'000'000'000);
  line.option("--move HOW", options.move,
              "how models move: own (as the scene does by itself), still, drift[:SIZES per step], "
              "turn[:DEGREES per step]");
  bool self = false;
  line.flag("--self", self, "find pairs within a model, too");
  line.flag("--triangles", options.rules.triangles,
            "test pairs of triangles exactly; otherwise their boxes count");
  line.flag("--open", options.rules.open, "objects that only touch are no pair");
  line.option("--voxel-size", options.rules.voxel_size,
              "edge of a voxel (default: chosen from the objects)")
      .positive();
  line.option(
          "--slack LENGTH", options.rules.slack,
          "on chares: keep the pairs of boxes that are larger by this, and test them alone while "
          "each object stays within its larger box")
      .positive();
  line.option("--repeat", options.repeat, "collisions per step; the fastest counts")
      .between(1, 1'000'000);
  line.option("--seed", options.seed, "of scenes with random places");
  line.flag("--serial", options.serial, "one thread, without the runtime (the default)");
  line.option("--json FILE", options.json, "write the result as JSON");
  line.option("--out PREFIX", options.out,
              "write PREFIX.svg (a picture), PREFIX_hits.vtp and PREFIX_pairs.vtp (ParaView), and "
              "the study's table and charts");
  line.flag("--explain", options.explain, "print what this run uses and what it leaves out");
  line.flag("--study", options.study,
            "voxel size, boxes and exact triangles: time against candidates and false positives");
  bool stability = false;
  line.flag("--stability", stability,
            "extreme scenes against brute force; exit code 1 if a pair is lost or doubled. Needs "
            "no INPUT");
  if (!line.parse(argc, argv, collide_scene::scenes_help() + tess::options_help())) return 0;
  if (self) options.rules.within_model = tess::collide::WithinModel::test;

  if (stability && options.inputs.empty())
    line.refuse_without("an INPUT", {"--steps", "--move", "--self", "--triangles", "--open",
                                     "--voxel-size", "--slack", "--repeat", "--seed", "--serial",
                                     "--json", "--out", "--explain", "--study"});
  const bool on_processes = setup.machine->n_processes() > 1;
  if (options.serial && (asked_for_pes || on_processes))
    tess::fail(tess::ErrorCode::bad_argument,
               "--serial: is one thread; leave it out, or --pes, --sim and mpirun");
  if (options.rules.slack > 0 && !asked_for_pes && !on_processes)
    tess::fail(tess::ErrorCode::bad_argument, "--slack: is for chares; add --pes, or leave it out");
  if (options.rules.slack > 0 && options.repeat > 1)
    tess::fail(tess::ErrorCode::bad_argument,
               "--repeat: with --slack only the first of equal collisions searches; leave one out");
  kit::FileNames names;
  for (const std::string& input : options.inputs) names.reads("INPUT", input);
  names.writes("--json", options.json);
  names.writes("--trace", setup.options.trace);
  const bool speaks = setup.machine->process().value == 0;
  if (stability && speaks && !collide_scene::print_stability()) return 1;
  if (options.inputs.empty()) {
    if (stability) return 0;
    tess::fail(tess::ErrorCode::bad_argument,
               "INPUT is missing; give files or a scene such as planes:65536 (--help)");
  }
  return collide_scene::drive(setup, options, asked_for_pes || on_processes);
}

}  // namespace

int main(int argc, char** argv) {
  const bool asked_for_pes = asks_for_pes(argc, argv);
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return run(setup, argc, argv, asked_for_pes); });
}
