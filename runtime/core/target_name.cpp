#include "runtime/core/target_name.hpp"

#include <boost/smart_ptr/intrusive_ref_counter.hpp>

#include <algorithm>
#include <vector>

namespace tess::detail {

struct LongName : boost::intrusive_ref_counter<LongName, boost::thread_safe_counter> {
  explicit LongName(std::span<const std::byte> of) : bytes(of.begin(), of.end()) {}
  std::vector<std::byte> bytes;
};

void intrusive_ptr_add_ref(const LongName* name) {
  boost::sp_adl_block::intrusive_ptr_add_ref(name);
}
void intrusive_ptr_release(const LongName* name) {
  boost::sp_adl_block::intrusive_ptr_release(name);
}

TargetName::TargetName(std::span<const std::byte> bytes) : n_(bytes.size()) {
  if (n_ <= short_.size())
    std::copy(bytes.begin(), bytes.end(), short_.begin());
  else
    long_ = new LongName(bytes);
}

bool TargetName::equal_long(const TargetName& a, const TargetName& b) {
  return a.long_->bytes == b.long_->bytes;
}

std::span<const std::byte> TargetName::long_view() const {
  return long_->bytes;
}

void TargetName::serialize(Reader& ar) {
  std::uint64_t n = 0;
  ar(n);
  *this = TargetName(ar.view(n));
}
void TargetName::serialize(Writer& ar) {
  const auto bytes = view();
  ar(std::uint64_t{bytes.size()});
  ar.bytes(bytes.data(), bytes.size());
}

}  // namespace tess::detail
