// expect: the pieces of a coupling are elements of arrays of one to three dimensions
#include "m2m/coupling.hpp"

class Fluid : public tess::Chare<Fluid, std::string>, public tess::m2m::Piece<Fluid> {
 public:
  tess::m2m::MeshView mesh_view() const { return {}; }
};

tess::TaskOf<tess::m2m::SearchSummary> misuse(tess::m2m::Coupling<Fluid, Fluid> coupling) {
  return coupling.search();
}
