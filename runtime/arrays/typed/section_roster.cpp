#include "runtime/arrays/typed/section_roster.hpp"

#include <utility>

namespace tess::detail {
namespace {

/// New lists are made if one of so many members is stale.
constexpr std::size_t most_stale = 16;

}  // namespace

void SectionRoster::create(std::size_t n_members) {
  created_ = true;
  n_unjoined_ = n_alive_ = n_members;
  members_.resize(n_members);
}

bool SectionRoster::seen(std::uint32_t ordinal, const Place& place) {
  Member& member = members_[ordinal];
  if (member.state == State::gone) return false;
  if (place.version > member.place.version) member.place = place;
  ++n_stale_;
  if (member.state == State::joined) return false;
  member.state = State::joined;
  ++n_outside_;
  --n_unjoined_;
  return true;
}

bool SectionRoster::gone(std::uint32_t ordinal) {
  Member& member = members_[ordinal];
  const State before = std::exchange(member.state, State::gone);
  --n_alive_;
  if (before == State::unjoined) {
    --n_unjoined_;
  } else if (member.listed) {
    ++n_stale_;
  } else {
    --n_outside_;
  }
  return before == State::unjoined;
}

bool SectionRoster::wants_lists() const {
  return most_stale * n_stale_ >= n_alive_ && n_stale_ > 0;
}

std::map<PeId, std::vector<std::uint32_t>> SectionRoster::new_lists() {
  n_stale_ = n_outside_ = 0;
  std::map<PeId, std::vector<std::uint32_t>> by_pe;
  for (std::uint32_t ordinal = 0; Member & member : members_) {
    member.listed = member.state == State::joined;
    if (member.listed) by_pe[member.place.pe].push_back(ordinal);
    ++ordinal;
  }
  return by_pe;
}

}  // namespace tess::detail
