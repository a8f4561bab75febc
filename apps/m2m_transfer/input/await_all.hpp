// Tasks that run together and write to what their caller holds.
#pragma once

#include "runtime/task.hpp"

#include <exception>
#include <vector>

namespace m2m_transfer {

/// Awaits all, also if one fails, and then throws the first error.
inline tess::Task await_all(std::vector<tess::Task> tasks) {
  std::exception_ptr error;
  for (tess::Task& task : tasks) {
    try {
      co_await task;
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace m2m_transfer
