#include "runtime/more/testing/shrink.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace tess::test::detail {
namespace {

class Search {
 public:
  Search(DecisionIds all, const FailsWith& fails, unsigned most_tries)
      : fails_(fails), most_tries_(most_tries), kept_(std::move(all)) {}

  Shrunk run() {
    if (kept_.empty() || try_with({})) return {{}, n_tries_, true};
    std::size_t n_chunks = 2;
    while (n_tries_ < most_tries_) {
      n_chunks = std::min(n_chunks, kept_.size());
      if (try_chunks(n_chunks)) {
        n_chunks = 2;
      } else if (n_chunks > 2 && try_complements(n_chunks)) {
        n_chunks = std::max<std::size_t>(n_chunks - 1, 2);
      } else if (n_chunks == kept_.size()) {
        break;
      } else {
        n_chunks *= 2;
      }
    }
    return {kept_, n_tries_, n_tries_ < most_tries_};
  }

 private:
  [[nodiscard]] DecisionIds chunk(std::size_t i, std::size_t n, bool complement) const {
    const auto at = [&](std::size_t k) {
      return kept_.begin() + static_cast<std::ptrdiff_t>(kept_.size() * k / n);
    };
    if (!complement) return {at(i), at(i + 1)};
    DecisionIds out(kept_.begin(), at(i));
    out.insert(out.end(), at(i + 1), kept_.end());
    return out;
  }
  bool try_chunks(std::size_t n) {
    if (kept_.size() < 2) return false;
    for (std::size_t i = 0; i < n; ++i)
      if (try_with(chunk(i, n, false))) return true;
    return false;
  }
  bool try_complements(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      if (try_with(chunk(i, n, true))) return true;
    return false;
  }
  bool try_with(const DecisionIds& some) {
    if (n_tries_ >= most_tries_) return false;
    ++n_tries_;
    std::optional<DecisionIds> came_up = fails_(some);
    if (!came_up) return false;
    kept_ = std::move(*came_up);
    return true;
  }

  const FailsWith& fails_;
  const unsigned most_tries_;
  DecisionIds kept_;
  unsigned n_tries_ = 0;
};

}  // namespace

Shrunk shrink(DecisionIds all, const FailsWith& fails, unsigned most_tries) {
  return Search(std::move(all), fails, most_tries).run();
}

}  // namespace tess::test::detail
