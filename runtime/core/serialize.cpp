#include "runtime/core/serialize.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/type_name.hpp"

#include <cstdlib>
#include <cxxabi.h>

namespace tess {
namespace {

/// "Circle" of "6Circle".
std::string demangled(const std::type_info& type) {
  char* const name = abi::__cxa_demangle(type.name(), nullptr, nullptr, nullptr);
  std::string text = plain_name(name != nullptr ? name : type.name());
  std::free(name);
  return text;
}

}  // namespace

void serialization::check_whole(const std::type_info& object, const std::type_info& written_as) {
  TESS_CHECK(object == written_as, "a unique_ptr to ", demangled(written_as), " holds a ",
             demangled(object),
             ", of which only the base class would be sent: hold a std::variant, or give the "
             "pointer's owner a serialize() that writes which class it is");
}

void Reader::refuse_bytes(std::size_t n) const {
  fail(ErrorCode::bad_value, "message ends early: ", n, " bytes wanted at byte ", at_, " of ",
       in_.size());
}

void Reader::refuse_length(std::uint64_t n) const {
  fail(ErrorCode::bad_value, "message ends early: ", n, " elements announced, ", remaining(),
       " bytes left");
}

void Reader::refuse_part(std::uint64_t n, const char* unit) {
  fail(ErrorCode::bad_value, "message has no attached part of ", n, unit);
}

void Reader::refuse_alternative(std::uint64_t which, std::size_t n) {
  fail(ErrorCode::bad_value, "message holds alternative ", which, " of a variant of ", n);
}

}  // namespace tess
