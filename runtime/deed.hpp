// What is done at once, or awaited: array.destroy() and `co_await array.destroy()`.
#pragma once

#include "runtime/epoch.hpp"

#include <utility>

namespace tess::detail {

/// Runs `body` at the end of the expression that makes it. If it is awaited, it runs then, and the
/// coroutine continues when all consequences of it are done, as those of an epoch().
template <class Body>
class Deed {
 public:
  explicit Deed(Body body) : body_(std::move(body)) {}
  Deed(const Deed&) = delete;
  Deed& operator=(const Deed&) = delete;
  ~Deed() {
    if (!awaited_) body_();
  }
  [[nodiscard]] EpochAwait<Body> operator co_await() {
    awaited_ = true;
    return EpochAwait<Body>(body_);
  }

 private:
  Body body_;
  bool awaited_ = false;
};

}  // namespace tess::detail
