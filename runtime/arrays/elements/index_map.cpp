#include "runtime/arrays/elements/index_map.hpp"

#include "runtime/wire/messages/read_all.hpp"

namespace tess::detail {

std::vector<std::byte> to_saved(const IndexMap* map) {
  if (map == nullptr) return {};
  const auto write = [map](Writer& ar) {
    ar(map->kind().id());
    pack_framed(ar, [map](Writer& members) { map->pack(members); });
  };
  Writer count{std::span<std::byte>()};
  write(count);
  std::vector<std::byte> bytes(count.n_bytes());
  Writer ar{std::span(bytes)};
  write(ar);
  return bytes;
}

std::shared_ptr<const IndexMap> from_saved(std::span<const std::byte> bytes) {
  if (bytes.empty()) return nullptr;
  Reader ar(bytes);
  const auto& kind = static_cast<const IndexMapKind&>(Registry::at(ar.take<std::uint32_t>()));
  return unpack_framed(ar, kind.name(), kind.unpack);
}

}  // namespace tess::detail
