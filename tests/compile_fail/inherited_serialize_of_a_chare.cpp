// expect: serialize() is inherited from a base class and may leave out members of this class
#include "runtime/runtime.hpp"

class Model {
 public:
  template <class Ar>
  void serialize(Ar& ar) {
    ar(temperature_);
  }

 private:
  double temperature_ = 0;
};

class Heat : public tess::Chare<Heat>, public Model {
 public:
  void warm() { ++n_warmings_; }

 private:
  int n_warmings_ = 0;
};

void misuse() {
  tess::create<Heat>(tess::range(8));
}
