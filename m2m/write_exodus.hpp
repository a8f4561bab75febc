// Writes a mesh with fields as ExodusII (NetCDF-3, 64-bit offsets), with one time step or several,
// for example for ParaView. The file appears complete or not at all: it is written under another
// name in the same folder, then renamed.
//
//     ExodusSteps out("result.exo", mesh);
//     for (int step = 0; step < 10; ++step) {
//       …
//       out.add(step * dt, std::array{temperature, velocity});
//     }
//     out.finish();
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <memory>
#include <span>
#include <string>

namespace tess::m2m {

/// A file that gets its time steps one by one. Only the fields of one step are in memory. Not
/// reentrant: one thread at a time.
class ExodusSteps {
 public:
  /// Writes the mesh with its blocks, side sets and node sets. `mesh` must outlive the object.
  /// Throws Error (bad_file, environment) with the path if the file cannot be written.
  ExodusSteps(const std::string& path, const TetMesh& mesh);
  /// If finish() was not called, no file remains.
  ~ExodusSteps();
  ExodusSteps(const ExodusSteps&) = delete;
  ExodusSteps& operator=(const ExodusSteps&) = delete;

  /// Adds a step. `vertex_fields` (n_points rows) become nodal variables, `tet_fields` (n_tets
  /// rows) element variables. A field of three components becomes NAME_x, NAME_y, NAME_z; any other
  /// number of components gives NAME_1, NAME_2, … The first step decides the names and components;
  /// all steps have the same. Throws Error (bad_value) if a name is not usable or given twice, or
  /// if the time is not after the last one, (environment) if the disk is full.
  void add(double time, std::span<const Field> vertex_fields,
           std::span<const Field> tet_fields = {});

  /// Gives the file its name; call it once, after the last step. Throws Error if that fails.
  void finish();

 private:
  struct Writing;
  std::unique_ptr<Writing> writing_;
};

/// Writes a mesh with one time step, 0: the same as ExodusSteps with one add(). No partial file
/// remains after an Error.
void write_exodus(const std::string& path, const TetMesh& mesh,
                  std::span<const Field> vertex_fields, std::span<const Field> tet_fields = {});

}  // namespace tess::m2m
