// Reads a value that fills all of its bytes. A type that reads fewer or more bytes than it wrote is
// reported here, by name, instead of by the value that is read next.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/core/serialize.hpp"

#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <string_view>

namespace tess::detail {

/// serialize() threw where no entry method runs that could catch it.
[[noreturn]] inline void refuse_reading(const std::string& what, std::size_t n_bytes,
                                        const char* error) {
  check_failed("read back", __FILE__, __LINE__,
               text(what, ": serialize() threw while it read ", n_bytes, " bytes: ", error,
                    "; does it read what it writes?"));
}

/// Calls read(body), which must read all of it. `what` returns the name for the report.
template <class What, class Read>
auto read_all(Reader& body, const What& what, const Read& read) {
  const std::size_t n_bytes = body.remaining();
  try {
    auto value = read(body);
    TESS_CHECK(body.remaining() == 0, what(), ": ", body.remaining(), " of ", n_bytes,
               " bytes are left when it is read back; does serialize() read what it writes?");
    return value;
  } catch (const std::bad_alloc&) {  // the message is lost, so the run cannot go on
    check_failed("memory", __FILE__, __LINE__,
                 text("memory is exhausted where ", what(), ", ", n_bytes,
                      " bytes and what is attached to them, is read; ask for less, give this "
                      "machine more, or see whether serialize() reads what it writes"));
  } catch (const std::exception& error) {
    refuse_reading(what(), n_bytes, error.what());
  } catch (...) {
    refuse_reading(what(), n_bytes, "an exception that is not a std::exception");
  }
}

/// Reads a value that is preceded by its length.
template <class Pack>
void pack_framed(Writer& ar, const Pack& pack) {
  const std::size_t at = ar.position();
  ar(std::uint64_t{0});
  pack(ar);
  ar.patch(at, static_cast<std::uint64_t>(ar.position() - at - sizeof(std::uint64_t)));
}
template <class Read>
auto unpack_framed(Reader& ar, std::string_view type, const Read& read) {
  Reader body = ar.part(ar.take<std::uint64_t>());
  return read_all(
      body, [type] { return plain_name(type); }, read);
}

}  // namespace tess::detail
