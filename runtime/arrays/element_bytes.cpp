// Elements as bytes, for migrations and checkpoints. The class gives only the function that writes
// an element, and the one that reads the members.
#include "runtime/arrays/collection.hpp"
#include "runtime/core/error.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <exception>
#include <string>

namespace tess::detail {

namespace {

/// Packs the element; the report of an exception names it, although none of its code runs.
void pack_named(Element& element, Collection::PackElement pack, Writer& ar) {
  try {
    pack(element, ar);
  } catch (...) {
    Pe& pe = current_pe();
    Context writes = pe.context();
    writes.element = &element;
    Context* const before = pe.enter(&writes);
    pe.error().note_place();
    pe.enter(before);
    throw;
  }
}

}  // namespace

std::uint64_t Collection::n_bytes_of(Element& element, PackElement pack) {
  Writer count{std::span<std::byte>()};
  pack_named(element, pack, count);
  return count.n_bytes();
}

Buffer Collection::bytes_of(Element& element, PackElement pack) {
  Buffer bytes;
  bytes.resize(n_bytes_of(element, pack));
  Writer ar{std::span(bytes.data(), bytes.size())};
  pack_named(element, pack, ar);
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

void Collection::read_saved_members(Element& element, Reader& ar) const {
  std::string wrong;
  try {
    read_members(element, ar);
    if (ar.remaining() != 0) wrong = text(ar.remaining(), " bytes are left");
  } catch (const std::exception& error) {
    wrong = error.what();
  } catch (...) {
    wrong = "an exception that is not a std::exception";
  }
  if (wrong.empty()) return;
  fail(ErrorCode::bad_file, "the checkpoint does not fit this program: ", name(),
       index_text_of(element), " has other members (", wrong,
       "); restart with the program that wrote it");
}

}  // namespace tess::detail
