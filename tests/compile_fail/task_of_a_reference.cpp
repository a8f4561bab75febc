// expect: a task gives a value: TaskOf<T> of a T that is no reference and not const
#include "runtime/runtime.hpp"

tess::TaskOf<const int&> misuse(const int& number) {
  co_return number;
}
