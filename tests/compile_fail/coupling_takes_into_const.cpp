// expect: a coupling takes values into memory of the chare: return std::span<double>
#include "m2m/coupling.hpp"

class Fluid : public tess::Chare<Fluid>, public tess::m2m::Piece<Fluid> {
 public:
  tess::m2m::MeshView mesh_view() const { return {}; }
  std::span<const double> temperature() const { return {}; }
  std::span<const double> heat() const { return {}; }
};

tess::Task misuse(tess::m2m::Coupling<Fluid, Fluid> coupling) {
  return coupling.apply<&Fluid::temperature, &Fluid::heat>();
}
