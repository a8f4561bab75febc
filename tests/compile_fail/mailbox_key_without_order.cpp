// expect: the key of a mailbox is compared with < and ==
#include "runtime/runtime.hpp"

struct Step {
  int phase = 0, round = 0;
};
struct Edge {
  Step step;
};

void misuse() {
  tess::Mailbox<&Edge::step> edges;
  edges.put(Edge());
}
