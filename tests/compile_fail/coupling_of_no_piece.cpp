// expect: a chare of a coupling derives from tess::m2m::Piece<of itself>, and has a public member
// function MeshView mesh_view() const
#include "m2m/coupling.hpp"

class Fluid : public tess::Chare<Fluid>, public tess::m2m::Piece<Fluid> {};

tess::TaskOf<tess::m2m::SearchSummary> misuse(tess::m2m::Coupling<Fluid, Fluid> coupling) {
  return coupling.search();
}
