// expect: serialize() is inherited from a base class and may leave out members of this class
#include "runtime/runtime.hpp"

class Particle {
 public:
  template <class Ar>
  void serialize(Ar& ar) {
    ar(mass_);
  }

 private:
  double mass_ = 1;
};
struct Charged : Particle {
  double charge = 1;
};

class Block : public tess::Chare<Block> {
 public:
  void take(std::vector<Charged> /*particles*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(std::vector<Charged>(3));
}
