// Step 6: an element that moves. It visits all PEs and takes its notes with it; messages follow it.
#include "runtime/runtime.hpp"

class Traveller : public tess::Chare<Traveller> {
 public:
  void visit(int n_left) {
    visited_.push_back(tess::my_pe().value);
    if (n_left == 0) return report();
    migrate_to(tess::PeId{(tess::my_pe().value + 1) % tess::n_pes()});  // after this entry method
    self().send<&Traveller::visit>(n_left - 1);  // wherever the element then is
  }

  template <class Ar>
  void serialize(Ar& ar) {  // what travels: packs, unpacks and counts bytes
    ar(visited_);
  }

 private:
  void report() {
    std::string list;
    for (const int pe : visited_) list = tess::text(list, " ", pe);
    tess::print("visited the PEs", list, "\n");
  }
  std::vector<int> visited_;
};

int main(int argc, char** argv) {
  return tess::run(argc, argv,
                   [] { tess::create<Traveller>(tess::range(1))[{0}].send<&Traveller::visit>(5); });
}
