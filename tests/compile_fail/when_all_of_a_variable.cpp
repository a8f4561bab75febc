// expect: a vector is moved in: when_all(std::move(vector))
#include "runtime/runtime.hpp"
#include "runtime/when.hpp"

tess::Task misuse(std::vector<tess::Task> tasks) {
  co_await tess::when_all(tasks);
}
