#include "runtime/reduce/section_reduction.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/completion/completion.hpp"

#include <algorithm>

namespace tess::detail {

SectionReduction::SectionReduction(SectionHost& host, Completion& completion, PeId here, PeId root,
                                   std::int32_t n_pes)
    : host_(host),
      completion_(completion),
      here_(here),
      root_(root),
      parent_(SpanningTree(here, root, n_pes).parent()) {
  for (const PeId pe : SpanningTree(here, root, n_pes).children())
    children_.push_back(Child{pe, {}, false});
}

SectionReduction::Child* SectionReduction::child(PeId pe) {
  const auto at = std::find_if(children_.begin(), children_.end(),
                               [pe](const Child& one) { return one.pe == pe; });
  return &*at;
}

bool SectionReduction::ready(std::uint32_t number) const {
  if (!passed(number)) return false;
  const Gathering* const gathering = gathering_.find(number);
  return std::all_of(children_.begin(), children_.end(), [&](const Child& one) {
    if (!one.attached || one.as.from > number) return true;
    if (gathering == nullptr) return false;
    const auto& reported = gathering->reported;
    return std::find(reported.begin(), reported.end(), std::pair(one.pe, one.as.time)) !=
           reported.end();
  });
}

void SectionReduction::send_to_root(std::uint32_t number, Gathered&& gathered) {
  if (gathered.n == 0) return;
  if (here_ == root_) {
    host_.arrived(number, std::move(gathered));
  } else {
    host_.send(root_, SectionReport{here_, {}, number, std::move(gathered)});
  }
}

void SectionReduction::send_up(std::uint32_t number, Gathered&& gathered) {
  if (here_ == root_) {
    send_to_root(number, std::move(gathered));
  } else {
    host_.send(parent_, SectionReport{here_, as_, number, std::move(gathered)});
  }
}

void SectionReduction::flush(std::uint32_t end) {
  while (!gathering_.empty() && gathering_.begin()->first < end) {
    const std::uint32_t number = gathering_.begin()->first;
    send_to_root(number, gathering_.take(number));
  }
}

void SectionReduction::advance() {
  const bool has_child = std::any_of(children_.begin(), children_.end(),
                                     [](const Child& one) { return one.attached; });
  if (members_at_.empty() && !has_child) {
    flush(~std::uint32_t{0});
    if (!attached_) return;
    attached_ = false;
    if (here_ != root_) host_.send(parent_, SectionAttach{here_, as_, false});
    return;
  }
  if (!attached_) {
    attached_ = true;
    std::uint32_t first = members_at_.empty() ? ~std::uint32_t{0} : members_at_.lowest();
    for (const Child& one : children_)
      if (one.attached) first = std::min(first, one.as.from);
    next_report_ = std::max(next_report_, first);
    flush(next_report_);
    as_ = Attachment{as_.time + 1, next_report_};
    if (here_ != root_) host_.send(parent_, SectionAttach{here_, as_, true});
  }
  while (ready(next_report_)) {
    const std::uint32_t number = next_report_++;
    send_up(number, gathering_.take(number));
  }
}

void SectionReduction::contribute(std::uint32_t number, EpochId epoch,
                                  std::unique_ptr<Partial> value) {
  leave(number);
  enter(number + 1);
  if (number < next_report_) {  // this PE has reported: the member arrived later
    Gathered one;
    one.add(completion_, epoch, std::move(value));
    send_to_root(number, std::move(one));
    return;
  }
  gathering_.add(completion_, number, epoch, std::move(value));
  if (passed(next_report_)) advance();
}

void SectionReduction::learn(const SectionAttach& attach) {
  Child& one = *child(attach.child);
  // Of two messages of one time the detachment is the later.
  if (attach.as.time < one.as.time || (attach.as.time == one.as.time && attach.attached)) return;
  one.as = attach.as;
  one.attached = attach.attached;
}

void SectionReduction::on_attach(const SectionAttach& attach) {
  learn(attach);
  advance();
}

void SectionReduction::on_report(SectionReport&& report) {
  if (report.as.time == 0) {
    host_.arrived(report.number, std::move(report.gathered));
    return;
  }
  learn(SectionAttach{report.child, report.as, true});  // the report may have overtaken it
  const Child& one = *child(report.child);
  if (one.as.time != report.as.time || !one.attached || report.number < next_report_) {
    send_to_root(report.number, std::move(report.gathered));
  } else {
    Gathering& gathering = gathering_[report.number];
    gathering.merge(std::move(report.gathered));
    gathering.reported.emplace_back(report.child, report.as.time);
  }
  advance();
}

void SectionReduction::end() {
  gathering_.drop(completion_);
}

std::uint64_t SectionReduction::n_waiting() const {
  std::uint64_t n = 0;
  for (const auto& [number, gathering] : gathering_) n += gathering.n;
  return n;
}

std::int64_t SectionTotal::members_of(std::uint32_t number) const {
  std::int64_t n = members_;
  for (const auto& [next, count] : removed_) {
    if (next > number) break;
    n -= count;
  }
  return n;
}

void SectionTotal::remove_member(std::uint32_t next) {
  TESS_CHECK(next >= next_complete_, "reduction ", next,
             " of a section is complete, but one of its members was destroyed before");
  removed_[next] += 1;
}

void SectionTotal::arrived(std::uint32_t number, Gathered&& gathered) {
  TESS_CHECK(number >= next_complete_, "reduction ", number,
             " of a section is complete, but a contribution arrives");
  whole_[number].merge(std::move(gathered));
}

bool SectionTotal::take(Gathered& whole) {
  const Gathered* const next = whole_.find(next_complete_);
  if (!begun_ || next == nullptr ||
      static_cast<std::int64_t>(next->n) != members_of(next_complete_))
    return false;
  whole = whole_.take(next_complete_);
  members_ = members_of(next_complete_);
  removed_.erase(removed_.begin(), removed_.upper_bound(next_complete_));
  ++next_complete_;
  return true;
}

void SectionTotal::end(Completion& completion) {
  whole_.drop(completion);
}

bool SectionTotal::first_incomplete(Incomplete& found) const {
  if (whole_.empty()) return false;
  const auto& [number, whole] = *whole_.begin();
  found = Incomplete{number, whole.n, members_of(number)};
  return true;
}

}  // namespace tess::detail
