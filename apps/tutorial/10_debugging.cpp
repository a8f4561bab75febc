// Step 10: a program that hangs. Partners in a chain wait for a greeting from the left and pass it
// on to the right; the one at the end passes it on to an element that does not exist, and the first
// waits for an answer that is never sent.
#include "runtime/runtime.hpp"

struct Greeting {
  int round = 0;
};

class Partner : public tess::Chare<Partner> {
 public:
  tess::Task play(int n_rounds) {
    for (int round = 0; round < n_rounds; ++round) {
      if (index().x > 0) (void)co_await greetings_.take(round);
      array()[{index().x + 1}].send<&Partner::receive>(Greeting{round});
    }
    if (index().x == 0) (void)co_await greetings_.take(n_rounds);
  }
  void receive(Greeting greeting) { greetings_.put(greeting); }

 private:
  tess::Mailbox<&Greeting::round> greetings_;
};

int main(int argc, char** argv) {
  return tess::run(argc, argv,
                   [] { tess::create<Partner>(tess::range(4)).broadcast<&Partner::play>(3); });
}
