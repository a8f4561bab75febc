// Eight chares in a row; each greets and passes on. The shortest program that shows an array and a
// message.
#include "runtime/runtime.hpp"

class Hello : public tess::Chare<Hello, tess::Index1> {
 public:
  void greet(int hops) {  // an entry method: any member that returns void or tess::Task
    tess::print("element ", index().x, ": hello after ", hops, " hops\n");
    if (index().x + 1 < array().size()) array()[{index().x + 1}].send<&Hello::greet>(hops + 1);
  }
};

int main(int argc, char** argv) {  // the lambda runs on PE 0; run() returns at quiescence
  return tess::run(argc, argv,
                   [] { tess::create<Hello>(tess::range(8))[{0}].send<&Hello::greet>(0); });
}
