#include "runtime/reduce/reduction_tree.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/completion/completion.hpp"

namespace tess::detail {

void ReductionTree::end() {
  gathering_.drop(completion_);
  whole_.drop(completion_);
}

ReductionTree::ReductionTree(ReductionHost& host, Completion& completion, PeId here, PeId root,
                             std::int32_t n_pes, TreeWords words, MembersOf of)
    : host_(host),
      completion_(completion),
      words_(std::move(words)),
      here_(here),
      root_(root),
      parent_(SpanningTree(here, root, n_pes).parent()),
      of_section_(of == MembersOf::section),
      children_(SpanningTree(here, root, n_pes), !of_section_) {}

ReductionTree::~ReductionTree() = default;

void ReductionTree::ask_children(std::uint32_t number, const Cause& cause) {
  for (const auto& child : children_) host_.send(child.pe, ReductionBegin{number, cause});
}

bool Cause::merge(const Cause& more) {
  met = std::max(met, more.met);
  if (more.led_by - 1 >= led_by - 1) return false;  // 0 means none and is ordered last
  led_by = more.led_by;
  return true;
}

void Reported::note(Newcomer&& other) {
  if (other.unawaited || other.created_after > newcomer.created_after)
    newcomer.element = std::move(other.element);
  newcomer.created_after = std::max(newcomer.created_after, other.created_after);
  newcomer.unawaited = newcomer.unawaited || other.unawaited;
}

bool Reported::merge(Reported&& more) {
  change += more.change;
  named = named || more.named;
  note(std::move(more.newcomer));
  const bool is_earlier = cause.merge(more.cause);
  Gathered::merge(std::move(more));
  return is_earlier;
}

bool ReductionTree::learn(std::uint32_t number, std::uint32_t led_by) {
  if (led_by == 0 || !led_to_.learn(led_by, number)) return false;
  host_.postpone_new_elements();
  return true;
}

void ReductionTree::take(std::uint32_t number, Gathering& into, const Cause& cause) {
  if (into.cause.merge(cause)) led_earlier(number, into);
}

void ReductionTree::led_earlier(std::uint32_t number, const Gathering& gathering) {
  (void)learn(number, gathering.cause.led_by);
  // A PE below that was asked or has reported may hold an element that waits for this number.
  if (gathering.asked || gathering.reported != 0) ask_children(number, gathering.cause);
}

void ReductionTree::take(std::uint32_t number, const Cause& cause) {
  if (number >= next_report_) {
    Gathering& gathering = gathering_[number];
    gathering.known = true;
    take(number, gathering, cause);
  } else if (learn(number, cause.led_by)) {
    ask_children(number, cause);
  }
}

std::uint32_t ReductionTree::admit() {
  whole_[next_complete_].change += 1;
  return next_complete_;
}

void ReductionTree::remove_member(std::uint32_t next) {
  if (next >= next_report_) {
    changes_[next] -= 1;
    return;
  }
  Reported gone;
  gone.change = -1;
  report_late(next, std::move(gone));
}

void ReductionTree::report_late(std::uint32_t number, Reported&& sum, std::uint32_t joins) {
  ReductionReport late{ReductionReport::What::late, here_, {}, number, std::move(sum)};
  late.joins = joins;
  host_.send(root_, std::move(late));
}

void ReductionTree::begin(std::uint64_t n_members) {
  begun_ = true;
  whole_[0].change += static_cast<std::int64_t>(n_members);
  complete_if_whole();
}

void ReductionTree::member_destroyed(std::uint32_t next) {
  require_open(next);
  whole_[next].change -= 1;
  complete_if_whole();
}

bool ReductionTree::is_empty() const {
  const Whole* const open = whole_.find(next_complete_);
  return begun_ && members_ + (open == nullptr ? 0 : open->change) == 0;
}

std::uint32_t ReductionTree::postpone(std::uint32_t next, std::uint32_t created_after) {
  const std::uint32_t later = led_to_.end(created_after);
  if (later <= next) return next;
  leave(next);
  enter(later);
  if (later < next_report_) {
    // One message, so that the root completes no number between the two changes.
    Reported moved;
    moved.change = -1;
    report_late(next, std::move(moved), later);
  } else {
    remove_member(next);
    add_member(later);
  }
  return later;
}

void ReductionTree::added(std::uint32_t number, const Cause& cause) {
  take(number, gathering_.added(completion_), cause);
  go_on(number);
}

void ReductionTree::contribute(std::uint32_t number, EpochId epoch, std::unique_ptr<Partial> value,
                               const Cause& cause, Newcomer newcomer) {
  leave(number);
  enter(number + 1);
  gather(number, epoch, std::move(value), cause, std::move(newcomer), false);
}

void ReductionTree::gather(std::uint32_t number, EpochId epoch, std::unique_ptr<Partial> value,
                           const Cause& cause, Newcomer newcomer, bool named) {
  if (number < next_report_) {  // this PE has reported: the element arrived later
    Reported late;
    late.add(completion_, epoch, std::move(value));
    late.cause = cause;
    late.newcomer = std::move(newcomer);
    late.named = named;
    report_late(number, std::move(late));
    return advance();  // the element may be ahead in the next numbers
  }
  Gathering& gathering = gathering_.add(completion_, number, epoch, std::move(value));
  gathering.known = true;
  gathering.named = gathering.named || named;
  gathering.note(std::move(newcomer));
  take(number, gathering, cause);
  if (ready(next_report_)) advance();
}

void ReductionTree::flush(std::uint32_t end) {
  while (!gathering_.empty() && gathering_.begin()->first < end) {
    const std::uint32_t number = gathering_.begin()->first;
    if (Gathering held = gathering_.take(number); held.n != 0) report_late(number, std::move(held));
  }
}

bool ReductionTree::attach() {
  const bool takes_part = !elements_at_.empty() || children_.any_attached();
  if (takes_part && !attached_) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    const std::uint32_t lowest = elements_at_.empty() ? none : elements_at_.lowest();
    next_report_ = std::max(next_report_, children_.first_below(lowest));
    flush(next_report_);
    as_ = Attachment{as_.time + 1, next_report_};
  } else if (!takes_part) {
    flush(~std::uint32_t{0});
  }
  if (std::exchange(attached_, takes_part) != takes_part && here_ != root_) {
    using What = ReductionReport::What;
    const What what = takes_part ? What::attached : What::detached;
    host_.send(parent_, ReductionReport{what, here_, as_, 0, {}});
  }
  return attached_;
}

void ReductionTree::advance() {
  if (of_section_ && !attach()) return;
  for (;;) {
    Gathering* const found = gathering_.find(next_report_);
    // A PE that is attached reports without being asked.
    if (!attached_ && (found == nullptr || !found->known)) return;
    if (!ready(next_report_)) return;
    if (!children_.have_reported(next_report_, found == nullptr ? 0 : found->reported)) {
      if (!of_section_ && !found->asked) {
        found->asked = true;
        ask_children(next_report_, found->cause);
      }
      return;
    }
    // An element that is created here after the report has received what led to the reduction.
    if (found != nullptr && found->cause.met > host_.applied_broadcast()) {
      awaited_broadcast_ = found->cause.met;
      return;
    }
    Gathering done = gathering_.take(next_report_);
    if (const auto change = changes_.find(next_report_); change != changes_.end()) {
      done.change += change->second;
      changes_.erase(change);
    }
    report(next_report_++, std::move(done));
  }
}

void ReductionTree::report(std::uint32_t number, Gathering&& gathered) {
  if (root_ != here_) {
    host_.send(parent_, ReductionReport{ReductionReport::What::sum, here_, as_, number,
                                        std::move(gathered)});
    return;
  }
  // Late contributions may have completed the number.
  if (of_section_ && gathered.n == 0) return;
  Whole& whole = whole_[number];
  whole.all_reported = true;
  whole.merge(std::move(gathered));
  complete_if_whole();
}

void ReductionTree::join(std::uint32_t number, std::string element) {
  if (number >= next_report_) return add_member(number);
  ++n_late_joins_;
  Reported late;
  late.change = 1;
  late.newcomer.element = std::move(element);
  report_late(number, std::move(late));
}

void ReductionTree::start_count() {
  if (counted_end_ != 0 || n_joined_ < n_joins_below_) return;
  n_joined_before_ = n_joined_;
  counted_end_ = next_complete_;
  for (std::int64_t members = members_; is_whole(counted_end_, members);) ++counted_end_;
  ReductionBegin begin;
  begin.counts = true;
  host_.send(here_, begin);  // the running code may contribute first and insert then
}

void ReductionTree::count_joins() {
  n_joins_below_ = n_late_joins_;
  ReductionBegin begin;
  begin.counts = true;
  for (const auto& child : children_) {
    ++n_uncounted_;
    host_.send(child.pe, begin);
  }
  if (n_uncounted_ == 0) joins_counted();
}

void ReductionTree::joins_counted() {
  if (root_ != here_) {
    ReductionReport report{ReductionReport::What::late_joins, here_, {}, 0, {}};
    report.n_joins = n_joins_below_;
    return host_.send(parent_, std::move(report));
  }
  if (n_joins_below_ == n_joined_before_ && n_joined_ == n_joined_before_)
    confirmed_end_ = counted_end_;
  counted_end_ = 0;
  complete_if_whole();
}

void ReductionTree::require_open(std::uint32_t number) const {
  // A member of a number contributes to it or is destroyed before the number is complete.
  TESS_CHECK(number >= next_complete_, words_.name, " ", number,
             " is complete, but a report of one of its members arrives: an element may have been ",
             "inserted too late to join there");
}

void ReductionTree::on_report(ReductionReport&& report) {
  switch (report.what) {
    case ReductionReport::What::sum:
      return on_sum(std::move(report));
    case ReductionReport::What::late:
      return on_late(std::move(report));
    case ReductionReport::What::attached:
    case ReductionReport::What::detached:
      children_.learn(report);
      return advance();
    case ReductionReport::What::late_joins:
      n_joins_below_ += report.n_joins;
      if (--n_uncounted_ == 0) joins_counted();
  }
}

void ReductionTree::on_late(ReductionReport&& report) {
  const Cause cause = report.sum.cause;
  const bool joins = report.sum.change > 0;
  TESS_CHECK(!joins || report.number >= next_complete_, report.sum.newcomer.element,
             " is inserted to join at round ", report.number, ", but ", words_.name, " ",
             report.number, " is complete: insert it before an element is called that ",
             "contributes to this round, or name a later one");
  if (joins) {
    ++n_joined_;
    confirmed_end_ = 0;
  }
  require_open(report.number);
  whole_[report.number].merge(std::move(report.sum));
  if (report.joins != 0) whole_[report.joins].change += 1;
  if (!of_section_) take(report.number, cause);
  advance();
  complete_if_whole();
}

void ReductionTree::on_sum(ReductionReport&& report) {
  children_.learn(report);  // it may have overtaken the news that the child is attached
  if (!children_.counts(report) || report.number < next_report_) {
    if (report.sum.n != 0) report_late(report.number, std::move(report.sum));
    return advance();
  }
  const Cause cause = report.sum.cause;
  Gathering& gathering = gathering_[report.number];
  gathering.known = true;
  if (gathering.merge(std::move(report.sum))) led_earlier(report.number, gathering);
  gathering.reported |= children_.bit(report.child);
  // The same holds for a PE that reported without this knowledge.
  if (cause.led_by != gathering.cause.led_by && !gathering.asked)
    ask_children(report.number, gathering.cause);
  advance();
}

void ReductionTree::on_begin(const ReductionBegin& begin) {
  if (begin.counts) return count_joins();
  take(begin.number, begin.cause);
  advance();
}

void ReductionTree::refuse_unawaited(const std::string& element, std::int64_t number) const {
  check_failed(
      "the round of a value is known", __FILE__, __LINE__,
      text(element, " contributes first to ", words_.name, " ", number,
           ", by a message that no broadcast of its array led to, but its insertion was "
           "not awaited: the value may be meant for a later round; name the rounds, "
           "insert(tess::RoundId{k}, …) and contribute(tess::RoundId{k}, …), or insert it in "
           "an awaited epoch while no round is under way"));
}

void ReductionTree::check_newcomer(const Reported& sum) const {
  const Newcomer& newcomer = sum.newcomer;
  if (newcomer.unawaited && sum.cause.led_by == 0)
    refuse_unawaited(newcomer.element, next_complete_);
  TESS_CHECK(newcomer.created_after == 0 || sum.cause.led_by - 1 >= newcomer.created_after,
             newcomer.element, " was created after broadcast ", newcomer.created_after,
             " and contributes to ", words_.name, " ", next_complete_, ", to which broadcast ",
             sum.cause.led_by,
             " led: rounds overlap, or it contributes without having received the broadcast; "
             "insert elements while no round is under way, or let them send a value to a chare");
}

bool ReductionTree::is_whole(std::uint32_t number, std::int64_t& members) const {
  const Whole* const whole = whole_.find(number);
  if (whole == nullptr || !(whole->all_reported || of_section_)) return false;
  members += whole->change;
  return static_cast<std::int64_t>(whole->n) == members;
}

void ReductionTree::complete_if_whole() {
  for (;;) {
    std::int64_t members = members_;
    if (!is_whole(next_complete_, members)) return;
    const Whole* const whole = whole_.find(next_complete_);
    if (whole->named && next_complete_ >= confirmed_end_) return start_count();
    members_ = members;
    check_newcomer(*whole);
    const Whole done = whole_.take(next_complete_);
    ++next_complete_;
    TESS_CHECK(next_complete_ < most_rounds, words_.name, " ", next_complete_,
               " is the last one of a collection: create another one");
    if (done.value.held) host_.deliver(*done.value.held, done.epoch());
    // The result has been sent in the same epoch before the contributions are settled.
    settle(completion_, done.shares);
  }
}

void ReductionTree::describe_waiting(std::vector<std::string>& lines) const {
  for (const auto& [number, gathering] : gathering_) {
    if (gathering.n == 0 && ready(number)) continue;
    lines.push_back(text(words_.name, " ", number, " has ", gathering.n,
                         gathering.n == 1 ? " contribution on " : " contributions on ", here_,
                         "; it waits for ",
                         ready(number) ? "other PEs" : words_.missing_before(number + 1)));
  }
  // Elements that arrived after this PE had reported; the reductions that they have yet to
  // contribute to are incomplete.
  if (!elements_at_.empty() && elements_at_.lowest() < next_report_)
    lines.push_back(text(words_.name, " ", elements_at_.lowest(), " waits for ",
                         words_.missing_before(next_report_)));
  std::int64_t members = members_;
  for (const auto& [number, whole] : whole_) {
    members += whole.change;
    if (whole.n != 0)
      lines.push_back(text(words_.name, " ", number, " has ", whole.n,
                           whole.n == 1 ? " contribution of " : " contributions of ", members,
                           " members"));
  }
}

}  // namespace tess::detail
