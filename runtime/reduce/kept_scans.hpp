// The contributions to scans that wait on a PE for the values before theirs. Each collection has
// such a list on each PE from its first scan on; arrays/typed/scan_partial.hpp says what is
// in it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

namespace tess::detail {

/// Contributions from one PE to one scan. They count as processed in their epochs when it ends.
class KeptScan {
 public:
  KeptScan() = default;
  KeptScan(const KeptScan&) = delete;
  KeptScan& operator=(const KeptScan&) = delete;
  virtual ~KeptScan() = default;
};

class KeptScans {
 public:
  std::uint64_t add(std::unique_ptr<KeptScan> scan) {
    kept_[++last_] = std::move(scan);
    return last_;
  }
  /// Takes a scan out of the list; there must be one of this number.
  [[nodiscard]] std::unique_ptr<KeptScan> take(std::uint64_t number) {
    return std::move(kept_.extract(number).mapped());
  }

 private:
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::unique_ptr<KeptScan>> kept_;
};

}  // namespace tess::detail
