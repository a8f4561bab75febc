// expect: an entry method of a process group returns void
#include "runtime/process_group.hpp"
#include "runtime/runtime.hpp"

class Cache {
 public:
  tess::Task load() {
    tess::Future<int> value;
    co_await value;
  }
};

void misuse(tess::ProcessGroupProxy<Cache> caches) {
  caches.broadcast<&Cache::load>();
}
