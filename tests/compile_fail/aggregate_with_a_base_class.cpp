// expect: an aggregate with a base class needs `template <class Ar> void serialize(Ar& ar)`
#include "runtime/runtime.hpp"

struct Particle {
  double mass = 1;
};
struct Charged : Particle {
  double charge = 1;
};

class Block : public tess::Chare<Block> {
 public:
  void take(Charged /*particle*/) {}
};

void misuse(tess::ArrayProxy<Block> blocks) {
  blocks[{0}].send<&Block::take>(Charged());
}
