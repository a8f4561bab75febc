// A scene: objects with their fields and motions, emitters of particles, rules, and outputs. Every
// process reads it once from the same file, and does not change it then. scene_help() describes the
// keys of the file.
#pragma once

#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/field.hpp"
#include "collide/dn_field/frame.hpp"
#include "collide/dn_field/rules.hpp"
#include "collide/dn_field/surface.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace particles {

/// An object with the field around it.
struct SceneObject {
  tess::dn::Surface surface;
  std::string file;      ///< that the surface is read from; empty: a built-in shape
  tess::dn::Grid grid;   ///< of the field
  double thickness = 0;  ///< of the field beyond the surface, in the object's units
  tess::dn::Method method = tess::dn::Method::exact;
  tess::dn::Sides sides = tess::dn::Sides::one;
  tess::dn::Blur blur;  ///< of the methods that blur; no rounds: chosen from the thickness
  std::string field;    ///< file that the field is read from; empty: it is built
  bool field_has_normals = true;
  tess::dn::Frame frame;  ///< at the first step, with its velocities
  /// The share of the surface at which particles may pass the field: walls and edges thinner than
  /// least_wall(). 0 for fields of two sides, and where no rule stops particles.
  double thin_share = 0;
};

/// The error bounds of compressed fields: by default no more than the error of nearest look-up.
struct Compression {
  double cells = 0.125;  ///< of the distance, in cells of the field
  double degrees = 3;    ///< of the normal
};

/// Where particles begin. Particle i of the scene is the same on every PE: its random numbers
/// depend on the seed and i only.
struct Emitter {
  enum class Where : std::uint8_t { box, sphere, lattice, surface } where = Where::box;
  std::uint64_t count = 0;
  tess::dn::Vec3 low, high;                       ///< box and lattice: corners
  tess::dn::Vec3 centre;                          ///< sphere
  double inner = 0, outer = 0;                    ///< sphere: radii; surface: distances from it
  std::array<std::uint64_t, 3> lattice{1, 1, 1};  ///< points along each axis
  std::size_t object = 0;                         ///< surface: of which object
  tess::dn::Vec3 velocity;
  double spread = 0;   ///< a random velocity up to this in each component
  double outward = 0;  ///< speed away from the centre (sphere) or along the normal (surface)
  double mass = 1;
  std::uint64_t seed = 1;
};

/// A plane in which the field of an object is drawn.
struct Slice {
  std::size_t object = 0;
  double at = 0;  ///< on the axis, in the object's units
};

/// The output of a run besides its table.
struct Outputs {
  int statistics = 0;          ///< a row of the table every so many steps; 0: first and last only
  int trajectories = 0;        ///< positions every so many steps; 0: none
  std::uint64_t traced = 200;  ///< how many particles, evenly spread over the ids
  std::vector<int> axes{2};    ///< the pictures look along these; that of the field along the first
  std::optional<Slice> slice;  ///< a picture of the field
  bool fields = false;         ///< files of the fields, for runs to come
  std::uint64_t audited = 0;   ///< how many particles are checked for tunnelling in each step
};

struct Scene {
  std::string name;  ///< as the user gave the file
  double dt = 0;
  int steps = 0;
  double block = 0;  ///< edge of the blocks of space that carry the particles; 0: chosen
  int exchange = 0;  ///< particles change blocks every so many steps; 0: chosen
  std::vector<SceneObject> objects;
  std::vector<Emitter> emitters;
  std::optional<Compression> compression;  ///< the fields are compressed; absent: they are flat
  tess::dn::Rules rules;                   ///< as forces: for_mass() makes accelerations of them
  Outputs outputs;

  [[nodiscard]] std::uint64_t n_particles() const;
};

/// The rules for particles of mass `mass`: forces become accelerations, gravity is one.
[[nodiscard]] tess::dn::Rules for_mass(tess::dn::Rules rules, double mass);

/// The masses of all emitters, each once, in the order of their first emitter.
[[nodiscard]] std::vector<double> masses_of(const Scene& scene);

/// How many particles are checked for tunnelling in each step; none where no rule needs a field.
[[nodiscard]] std::uint64_t n_audited(const Scene& scene);

/// Reads and checks a scene. Throws tess::Error: one line that names the key, the value, and what
/// is allowed.
[[nodiscard]] Scene read_scene(const std::string& path);

/// The same from a text; files that it names are looked for beside `name`.
[[nodiscard]] Scene parse_scene(const std::string& text, const std::string& name);

/// Checks that rules, masses, motions, steps and fields fit one another. Readers do it; to be
/// repeated after a change of a scene. Throws tess::Error.
void check_scene(const Scene& scene);

/// Throws Error (bad_file) for a field from a file without normals.
void require_normals(const SceneObject& object);

/// Whether rules, a picture or outputs need the fields.
[[nodiscard]] bool builds_fields(const Scene& scene);

/// The least and the greatest scale of an object in the whole run.
[[nodiscard]] double least_scale(const Scene& scene, const SceneObject& object);
[[nodiscard]] double greatest_scale(const Scene& scene, const SceneObject& object);

/// The least thickness of a wall, in the object's units, that its field can represent: a voxel's
/// diagonal; by nearest look-up, which errs by half of one where it stops and lifts particles, and
/// on both sides of a wall that moves, three.
[[nodiscard]] double least_wall(const tess::dn::Rules& rules, const SceneObject& object);

/// Sets the compression, within the scene's bounds or the usual ones. Throws where the scene has a
/// look-up that compressed fields do not support, or writes files of the fields.
void compress_fields(Scene& scene);

/// All keys of a scene file, with their units and defaults.
[[nodiscard]] std::string scene_help();

}  // namespace particles
