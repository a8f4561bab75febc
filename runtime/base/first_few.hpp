// The first few of many things as text, for reports of what is missing.
#pragma once

#include <cstddef>
#include <string>

namespace tess::detail {

/// Collects words: "Block[3], Block[5] and 7 more".
class FirstFew {
 public:
  /// `words()` is called for those that are named.
  template <class Words>
  void add(const Words& words) {
    if (++n_ <= most) text_ += (n_ > 1 ? ", " : "") + words();
  }
  [[nodiscard]] std::string text() const {
    return n_ <= most ? text_ : text_ + " and " + std::to_string(n_ - most) + " more";
  }

 private:
  static constexpr std::size_t most = 5;
  std::string text_;
  std::size_t n_ = 0;
};

}  // namespace tess::detail
