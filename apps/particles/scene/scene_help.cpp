#include "apps/particles/scene/scene.hpp"

namespace particles {

std::string scene_help() {
  return R"(A scene is one JSON object. Lengths, times and masses are in any units that agree. [x, y, z]: three
numbers. A key without a default must be given; an unknown key, a key twice or a value out of its
range is an error that names it. No number is beyond 1e100, and none that must be above 0 is below 1e-100;
cells, thicknesses and cells a step of fields are within 1e-15 … 1e15.

dt          time step, above 0
steps       how many, 0 … 1e9
block       edge of the blocks of space that carry the particles (default: chosen)
exchange    particles change blocks every so many steps (default: chosen); no result depends on it
compression {"cells": 0.125, "degrees": 3}: fields are compressed, and steps look up in them; so far, in
            cells and degrees, a voxel's distance (0 … 0.5) and normal (0 … 45) may be off. Not with trilinear
            look-up; refused where 32 bits a cell do not hold that. {} and --compressed take the defaults (default:
            flat fields)
objects     a list (default: none); of each:
  shape       one of
                {"sphere": {"radius": r, "rings": 48}}
                {"box": {"half": [x, y, z]}}
                {"boxes": [{"low": [x, y, z], "high": [x, y, z]}, …]}   their union
                {"torus": {"major": r, "minor": r, "n": 64}}            around the z axis
                {"cylinder": {"radius": r, "half_height": h, "sides": 64}}   along the z axis
                {"plate": {"half": h, "n": 1}}                          in the plane z = 0
                {"file": "mesh.obj"}                                    or .ply, .stl; relative to the scene file; closed parts that
                    overlap keep their inner faces, which count as surface: join them before
  resolution  voxels along each axis of the field, 4 … 1024 (default 60)
  thickness   of the field beyond the object, in its own units (default: a quarter of its extent)
  choose      instead of resolution and thickness: {"max_speed": v, "detail": d}: the field covers a step at speed v
              and has two voxels across d
  method      exact (default), normals, potential
  sides       one (default): negative distances inside; two: thin shells, distances from either side
  blur        {"radius": 2 … 4 voxels, "rounds": n}: of normals and potential (default: through the thickness)
  field       "field_0.dnf": instead of resolution, thickness, choose, method, sides and blur, the field from a
              file that outputs.fields wrote, relative to the scene file; one of another shape is refused
  transform   {"position": [x, y, z], "rotation": [x, y, z] (degrees about that vector), "scale": s}
              or {"position": …, "matrix": [row, row, row]}: rotation times uniform scale, no shear
  motion      {"velocity": [x, y, z], "spin": [x, y, z] (radians a second about that vector), "scale": r}:
              the transform's scale grows by r a second, uniformly about the position; a surface at the
              distance a from there, in the object's units, moves outward at r a, and particles feel that
              velocity. Negative: it shrinks; the scale must stay above 0 for the whole run
emitters    a list of at least one; of each:
  one of      "box": {"low": …, "high": …}                uniform
              "sphere": {"centre": …, "radius": r, "inner": 0}   uniform between two radii
              "lattice": {"low": …, "high": …, "n": [nx, ny, nz]}   both corners included
              "surface": {"object": 0, "low": 0, "high": d}   at distances low … high (at least 0)
  count       how many particles, 1 … 1e9 (not with a lattice)
  velocity    [x, y, z] (default 0)
  spread      a random velocity up to this in each component (default 0)
  outward     speed away from the sphere's centre, or along the surface's normal (default 0)
  mass        above 0 (default 1); see rules
  seed        of the random numbers, 0 … 2^53 (default 1); particle i is the same on any number of PEs
rules       each may be left out. Stiffness, damping, rates, alphas and strength are of forces: they are divided by
            the mass of the emitter's particles. Gravity is an acceleration
  look_up     nearest (not with springs), tangent (default), trilinear
  spring      {"stiffness": k, "reach": d, "damping": 0}          force over depth below d
  impact      {"restitution": 0 … 1, "threshold": 0, "sweep": true}
  surface_drag   {"rate": c, "threshold": d}
  surface_flow   {"alpha_in": a, "alpha_out": a, "distance": d}
  gravity     [x, y, z]
  wind        {"velocity": [x, y, z], "rate": c}
  air_drag    {"rate": c, "law": "linear" or "quadratic"}
  explosions  [{"centre": …, "strength": f, "radius": r, "start": 0, "duration": t}, …]
outputs
  statistics  a row of the table every so many steps (default 0: the first and the last alone)
  audit       how many particles, evenly spread over the ids, are checked for tunnelling in each step, which makes
              their steps 4 to 10 times as long; true: all (default: false; all are checked after the last step)
  trajectories   positions every so many steps, with --out: VTP files, a .pvd series, a picture (objects as
              they stand at first, moving ones in outline as they stand at last)
  traced      how many particles the trajectories hold (default 200)
  axis        "x", "y" or "z" (default): along which the pictures look; ["z", "x"]: paths from two sides
  fields      true: with --out, the fields as they were built, field_0.dnf for the first object, …; not with
              compression
  slice       {"object": 0, "at": 0}: with --out, a picture of the object's field, cut at that place on the axis
)";
}

}  // namespace particles
