// expect: when_all and when_any take asks, futures, epochs, mailbox.take(…) and tess::sleep(…)
#include "runtime/runtime.hpp"
#include "runtime/when.hpp"

void misuse() {
  (void)tess::when_any(tess::sleep(std::chrono::milliseconds(1)), 5);
}
