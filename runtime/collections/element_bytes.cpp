// Elements as bytes, for migrations and checkpoints. The class gives only the function that writes an
// element, and the one that reads the members.
#include "runtime/collections/collection.hpp"
#include "runtime/messages/read_all.hpp"

namespace tess::detail {

std::uint64_t Collection::n_bytes_of(Element& element, PackElement pack) {
  Writer count{std::span<std::byte>()};
  pack(element, count);
  return count.n_bytes();
}

Buffer Collection::bytes_of(Element& element, PackElement pack) {
  Buffer bytes;
  bytes.resize(n_bytes_of(element, pack));
  Writer ar{std::span(bytes.data(), bytes.size())};
  pack(element, ar);
  return bytes;
}

void Collection::read_all_members(Element& element, Reader& ar) const {
  read_all(
      ar, [&] { return name() + index_text_of(element); },
      [&](Reader& rest) {
        read_members(element, rest);
        return true;
      });
}

}  // namespace tess::detail
