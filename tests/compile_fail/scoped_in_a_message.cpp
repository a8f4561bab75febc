// expect: a Scoped cannot be sent, since the copy would own the same thing
#include "runtime/runtime.hpp"
class N : public tess::Chare<N> {
 public:
  void keep(tess::Scoped<tess::ArrayProxy<N>> /*scope*/) {}
};
void f(tess::ArrayProxy<N> array) {
  array[{0}].send<&N::keep>(tess::Scoped(array));
}
