// Couplings, colliders and searches that do not compile.
#include "collide/collider.hpp"
#include "collide/pairs.hpp"
#include "collide/queries.hpp"
#include "m2m/coupling.hpp"

#include <span>
#include <string>
#include <vector>

using tess::m2m::Coupling;

struct Fluid : tess::Chare<Fluid>, tess::m2m::Piece<Fluid> {
  tess::m2m::MeshView mesh_view() const { return {}; }
  std::vector<double> vector() const { return {}; }
  std::span<double> heat() { return {}; }
  std::span<const double> temperature() const { return {}; }
  std::span<const double> const_heat() const { return {}; }
};

// expect: a coupling gives values that the chare keeps: return std::span<const double>, not a vector, which would end before it is read
tess::Task coupling_gives_a_vector(Coupling<Fluid, Fluid> coupling) {
  return coupling.apply<&Fluid::vector, &Fluid::heat>();
}

// expect: a coupling takes values into memory of the chare: return std::span<double>
tess::Task coupling_takes_into_const(Coupling<Fluid, Fluid> coupling) {
  return coupling.apply<&Fluid::temperature, &Fluid::const_heat>();
}

// expect: the pieces of a coupling are elements of arrays of one to three dimensions
struct Named : tess::Chare<Named, std::string>, tess::m2m::Piece<Named> {
  tess::m2m::MeshView mesh_view() const { return {}; }
};
void coupling_of_named_pieces(Coupling<Named, Named> coupling) {
  (void)coupling.search();
}

// expect: a chare of a coupling derives from tess::m2m::Piece<of itself>, and has a public member function MeshView mesh_view() const
struct NoPiece : tess::Chare<NoPiece>, tess::m2m::Piece<NoPiece> {};
void coupling_of_no_piece(Coupling<NoPiece, NoPiece> coupling) {
  (void)coupling.search();
}

// expect: an owner of objects is an element of an array of one to three dimensions
struct Owner : tess::Chare<Owner, tess::Index4> {
  void receive(const tess::collide::Hits& /*hits*/) {}
};
tess::collide::HitReceivers owner_of_four_dimensions(tess::ArrayProxy<Owner> owners) {
  return {tess::collide::report_to<&Owner::receive>(owners), {}};
}

// expect: objects that are searched need Box<Real, D> box_of(const Object&) beside their type
struct Ring {
  double x = 0, y = 0, radius = 0;
};
inline bool intersect(const Ring&, const Ring&, tess::collide::Touching) {
  return true;
}
void pairs_without_boxes(const std::vector<Ring>& rings) {
  (void)tess::collide::count_pairs(std::span<const Ring>(rings));
}

// expect: pairs of objects that are no boxes need bool intersect(const A&, const B&, Touching)
struct Disc {
  double x = 0, y = 0;
};
inline tess::collide::Box<double, 2> box_of(const Disc& disc) {
  return {{disc.x - 1, disc.y - 1}, {disc.x + 1, disc.y + 1}};
}
void pairs_without_intersect(const std::vector<Disc>& discs) {
  (void)tess::collide::count_pairs(std::span<const Disc>(discs));
}

// expect: nearest() needs a function distance2(const Object&, const Point&) beside the type
struct Cloud {
  tess::collide::Aabb box;
};
tess::collide::Aabb box_of(const Cloud& cloud) {
  return cloud.box;
}
void nearest_without_distance(const tess::collide::Index<Cloud>& clouds) {
  (void)clouds.nearest({0, 0, 0}, 1);
}

// expect: a point or a segment is hit by no ray
void ray_at_points(const tess::collide::Index<tess::collide::Point>& points) {
  (void)points.first_hit({{0, 0, 0}, {1, 0, 0}});
}
