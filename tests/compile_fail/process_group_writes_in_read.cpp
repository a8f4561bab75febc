// expect: read() takes a function of (const G&)
#include "runtime/process_group.hpp"
#include "runtime/runtime.hpp"

class Cache {
 public:
  void put() {}
};

void misuse(tess::ProcessGroupProxy<Cache> caches) {
  caches.read([](Cache& cache) { cache.put(); });
}
