// expect: the value has another type than the target
#include "runtime/runtime.hpp"

class Block : public tess::Chare<Block> {
 public:
  void add(tess::Callback<double> target) { contribute(tess::sum, 1, target); }
};
