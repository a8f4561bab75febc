#include "runtime/core/serialize.hpp"

namespace tess {

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
