// expect: an owner of objects is an element of an array of one to three dimensions
#include "collide/collider.hpp"

class Owner : public tess::Chare<Owner, tess::Index4> {
 public:
  void receive(const tess::collide::Hits& /*hits*/) {}
};

tess::collide::Report misuse(tess::ArrayProxy<Owner> owners) {
  return {tess::collide::report_to<&Owner::receive>(owners), {}};
}
