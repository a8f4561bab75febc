// Step 1: an array of four chares. One broadcast calls an entry method of each.
#include "runtime/runtime.hpp"

class Greeter : public tess::Chare<Greeter> {
 public:
  void greet(const std::string& name) {
    tess::print("element ", index().x, " of ", array().size(), " says hello to ", name, "\n");
  }
};

int main(int argc, char** argv) {
  return tess::run(argc, argv, [] {
    const auto greeters = tess::create<Greeter>(tess::range(4));
    greeters.broadcast<&Greeter::greet>("Ada");
  });
}
