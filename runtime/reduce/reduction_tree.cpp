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
                             std::int32_t n_pes, TreeWords words)
    : host_(host),
      completion_(completion),
      words_(std::move(words)),
      here_(here),
      root_(root),
      parent_(SpanningTree(here, root, n_pes).parent()),
      children_(SpanningTree(here, root, n_pes).children()) {}

ReductionTree::~ReductionTree() = default;

void ReductionTree::ask_children(std::uint32_t number, const Cause& cause) {
  for (const PeId child : children_) host_.send(child, ReductionBegin{number, cause});
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
  if (gathering.asked || gathering.children > 0) ask_children(number, gathering.cause);
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
  send_late_change(next, 0);
}

void ReductionTree::send_late_change(std::uint32_t number, std::uint32_t joins) {
  ReductionReport late;
  late.number = number;
  late.sum.change = -1;
  late.late = true;
  late.joins = joins;
  host_.send(root_, std::move(late));
}

std::uint32_t ReductionTree::postpone(std::uint32_t next, std::uint32_t created_after) {
  const std::uint32_t later = led_to_.end(created_after);
  if (later <= next) return next;
  leave(next);
  enter(later);
  if (later < next_report_) {
    send_late_change(
        next, later);  // one message, so that the root completes no number between the two changes
  } else {
    remove_member(next);
    add_member(later);
  }
  return later;
}

void ReductionTree::enter(std::uint32_t next) {
  elements_at_.add(next);
}

void ReductionTree::leave(std::uint32_t next) {
  elements_at_.remove(next);
}

void ReductionTree::added(std::uint32_t number, const Cause& cause) {
  Gathering& gathering = gathering_.added(completion_);
  take(number, gathering, cause);
  leave(number);
  enter(number + 1);
  if (ready(next_report_)) advance();
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
    ReductionReport late;
    late.number = number;
    late.late = true;
    late.sum.add(completion_, epoch, std::move(value));
    late.sum.cause = cause;
    late.sum.newcomer = std::move(newcomer);
    late.sum.named = named;
    host_.send(root_, std::move(late));
    return advance();  // the element may be ahead in the next numbers
  }
  Gathering& gathering = gathering_.add(completion_, number, epoch, std::move(value));
  gathering.known = true;
  gathering.named = gathering.named || named;
  gathering.note(std::move(newcomer));
  take(number, gathering, cause);
  advance();
}

bool ReductionTree::ready(std::uint32_t number) const {
  return elements_at_.empty() || elements_at_.lowest() > number;
}

void ReductionTree::advance() {
  for (;;) {
    Gathering* const found = gathering_.find(next_report_);
    if (found == nullptr || !found->known || !ready(next_report_)) return;
    Gathering& gathering = *found;
    if (static_cast<std::size_t>(gathering.children) < children_.size()) {
      if (!gathering.asked) {
        gathering.asked = true;
        ask_children(next_report_, gathering.cause);
      }
      return;
    }
    // An element that is created here after the report has received what led to the reduction.
    if (gathering.cause.met > host_.applied_broadcast()) {
      awaited_broadcast_ = gathering.cause.met;
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
    host_.send(parent_, ReductionReport{number, std::move(gathered)});
    return;
  }
  Whole& whole = whole_[number];
  whole.all_reported = true;
  whole.merge(std::move(gathered));
  complete_if_whole();
}

void ReductionTree::join(std::uint32_t number, std::string element) {
  if (number >= next_report_) return add_member(number);
  ++n_late_joins_;
  ReductionReport late;
  late.number = number;
  late.sum.change = 1;
  late.sum.newcomer.element = std::move(element);
  late.late = true;
  host_.send(root_, std::move(late));
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
  n_uncounted_ = children_.size();
  ReductionBegin begin;
  begin.counts = true;
  for (const PeId child : children_) host_.send(child, begin);
  if (n_uncounted_ == 0) joins_counted();
}

void ReductionTree::joins_counted() {
  if (root_ != here_) {
    ReductionReport report;
    report.counts = true;
    report.n_joins = n_joins_below_;
    return host_.send(parent_, std::move(report));
  }
  if (n_joins_below_ == n_joined_before_ && n_joined_ == n_joined_before_)
    confirmed_end_ = counted_end_;
  counted_end_ = 0;
  complete_if_whole();
}

void ReductionTree::on_report(ReductionReport&& report) {
  if (report.counts) {
    n_joins_below_ += report.n_joins;
    if (--n_uncounted_ == 0) joins_counted();
    return;
  }
  const Cause cause = report.sum.cause;
  if (report.late) {
    const bool joins = report.sum.change > 0;
    TESS_CHECK(!joins || report.number >= next_complete_, report.sum.newcomer.element,
               " is inserted to join at round ", report.number, ", but ", words_.name, " ",
               report.number, " is complete: insert it before an element is called that ",
               "contributes to this round, or name a later one");
    if (joins) {
      ++n_joined_;
      confirmed_end_ = 0;
    }
    // A member of a number contributes to it or is destroyed before the number is complete.
    TESS_CHECK(
        report.number >= next_complete_, words_.name, " ", report.number,
        " is complete, but a report of one of its members arrives: an element may have been ",
        "inserted too late to join there");
    whole_[report.number].merge(std::move(report.sum));
    if (report.joins != 0) whole_[report.joins].change += 1;
    take(report.number, cause);
    advance();
    complete_if_whole();
    return;
  }
  Gathering& gathering = gathering_[report.number];
  gathering.known = true;
  if (gathering.merge(std::move(report.sum))) led_earlier(report.number, gathering);
  ++gathering.children;
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
  if (whole == nullptr || !whole->all_reported) return false;
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
  for (const auto& [number, whole] : whole_) {
    if (whole.n != 0)
      lines.push_back(text(words_.name, " ", number, " has ", whole.n,
                           whole.n == 1 ? " contribution of " : " contributions of ",
                           members_ + whole.change, " members"));
  }
}

}  // namespace tess::detail
