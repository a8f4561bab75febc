// expect: a coupling gives values that the chare keeps: return std::span<const double>, not a
// vector, which would end before it is read
#include "m2m/coupling.hpp"

class Fluid : public tess::Chare<Fluid>, public tess::m2m::Piece<Fluid> {
 public:
  tess::m2m::MeshView mesh_view() const { return {}; }
  std::vector<double> temperature() const { return {}; }
  std::span<double> heat() { return {}; }
};

tess::Task misuse(tess::m2m::Coupling<Fluid, Fluid> coupling) {
  return coupling.apply<&Fluid::temperature, &Fluid::heat>();
}
