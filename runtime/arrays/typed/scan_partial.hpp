// A scan on its way (runtime/more/scan.hpp has the picture): the contributions that stay on their PE, the
// runs of indices that go up the tree as the value of a reduction, and the answers of the root.
#pragma once

#include "runtime/arrays/collection_action.hpp"
#include "runtime/arrays/typed/contribution.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/reduce/kept_scans.hpp"
#include "runtime/reduction.hpp"
#include "runtime/wire/messages/entry_attributes.hpp"

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess::detail {

template <class Op>
struct ScanOp {
  using Type = Op;
  static constexpr bool in_runs = true;
  static const Op& of(const Op& op) { return op; }
};
template <class Op>
struct ScanOp<InOrder<Op>> {
  using Type = Op;
  static constexpr bool in_runs = false;
  static const Op& of(const InOrder<Op>& op) { return op.op; }
};

/// The types of a scan: `Op` combines two values of type T, and `Result` is what the elements get.
template <class Key_, class Op_, class T_, class Result_, bool in_runs_>
struct ScanTypes {
  using Key = Key_;
  using Op = Op_;
  using T = T_;
  using Result = Result_;
  static constexpr bool in_runs = in_runs_;
};

/// True if `b` follows `a` and no index can stand between them.
template <class Key>
[[nodiscard]] bool adjoin(const Key& a, const Key& b) {
  if constexpr (is_one_of<Key, Index1, Index2, Index3, Index4, Index5, Index6>) {
    const auto from = std::bit_cast<std::array<std::int32_t, sizeof(Key) / 4>>(a);
    const auto to = std::bit_cast<std::array<std::int32_t, sizeof(Key) / 4>>(b);
    for (std::size_t axis = 0; axis + 1 < from.size(); ++axis)
      if (from[axis] != to[axis]) return false;
    return std::int64_t{from.back()} + 1 == std::int64_t{to.back()};
  } else {
    return false;
  }
}

template <class Types>
using ScanRuns = std::vector<std::pair<typename Types::Key, typename Types::T>>;

/// The contributions of one PE to one scan, which stay there.
template <class Types>
class ScanOfPe final : public KeptScan {
 public:
  using T = typename Types::T;
  struct Contribution {
    typename Types::Key key;
    T value;
    std::optional<T> first;  ///< of an exclusive scan
    Counted counted;
    Callback<typename Types::Result> target;
  };

  void add(Contribution&& one) { contributions_.push_back(std::move(one)); }
  void add(ScanOfPe&& more) {
    contributions_.insert(contributions_.end(),
                          std::make_move_iterator(more.contributions_.begin()),
                          std::make_move_iterator(more.contributions_.end()));
  }

  /// The first index of each run and its combined value, in the order of indices.
  [[nodiscard]] ScanRuns<Types> runs(const typename Types::Op& op) {
    std::sort(contributions_.begin(), contributions_.end(),
              [](const Contribution& a, const Contribution& b) { return a.key < b.key; });
    ScanRuns<Types> runs;
    for (std::size_t i = 0; i < contributions_.size(); ++i) {
      if (begins_run(i)) {
        runs.emplace_back(contributions_[i].key, contributions_[i].value);
      } else {
        runs.back().second = combined(op, std::move(runs.back().second), contributions_[i].value);
      }
    }
    return runs;
  }

  /// Gives the elements their results: `before` has what stands before each run.
  void give(Pe& pe, const typename Types::Op& op, std::vector<std::optional<T>>&& before) {
    Element* const contributor = std::exchange(pe.context().element, nullptr);
    std::optional<T> sum;
    std::size_t run = 0;
    for (std::size_t i = 0; i < contributions_.size(); ++i) {
      Contribution& one = contributions_[i];
      if (begins_run(i)) sum = std::move(before[run++]);
      std::optional<T> whole = sum ? combined(op, *sum, one.value) : one.value;
      const DeliveryScope scope(pe, one.counted.epoch());
      if (!one.first) {
        one.target(finished(op, *whole));
      } else if (sum) {
        one.target(finished(op, combined(op, std::move(*one.first), *sum)));
      } else {
        one.target(finished(op, std::move(*one.first)));
      }
      sum = std::move(whole);
    }
    pe.context().element = contributor;
  }

 private:
  [[nodiscard]] bool begins_run(std::size_t i) const {
    return !Types::in_runs || i == 0 || !adjoin(contributions_[i - 1].key, contributions_[i].key);
  }

  std::vector<Contribution> contributions_;
};

/// The runs of a scan on their way to the root, with the PEs that hold them. On the PE of its own
/// elements it is open: their contributions are still collected there.
template <class Types>
class ScanPartial final : public Partial {
 public:
  using Key = typename Types::Key;
  using Op = typename Types::Op;
  using T = typename Types::T;
  using Here = ScanOfPe<Types>;

  ScanPartial(Collection& collection, Op op)
      : op_(std::move(op)), collection_(collection.id()), here_(&collection) {}

  static const PartialKind& its_kind() { return kind_; }
  [[nodiscard]] const PartialKind& kind() const override { return kind_; }

  void add(Collection& collection, const Op& op, typename Here::Contribution&& one) {
    require_one_operation(op_, op);
    open(collection).add(std::move(one));
  }
  void merge(Partial&& other) override {
    auto& more = static_cast<ScanPartial&>(other);
    require_one_operation(op_, more.op_);
    parts_.insert(parts_.end(), std::make_move_iterator(more.parts_.begin()),
                  std::make_move_iterator(more.parts_.end()));
    if (more.kept_ == nullptr) return;
    open(*more.here_).add(std::move(*more.kept_));
    (void)more.here_->kept_scans().take(more.number_);
  }
  void leave() override {
    if (kept_ == nullptr) return;
    parts_.push_back(PeRuns{here_->pe().id(), number_, kept_->runs(op_)});
    kept_ = nullptr;
    here_ = nullptr;
  }
  void pack(Writer& ar) const override { ar(op_, collection_, parts_); }
  void complete(Pe& pe) override {
    leave();
    struct RunAt {
      std::size_t part;
      std::size_t run;
    };
    std::vector<RunAt> places;
    for (std::size_t part = 0; part < parts_.size(); ++part)
      for (std::size_t run = 0; run < parts_[part].runs.size(); ++run)
        places.push_back({part, run});
    const auto at = [this](const RunAt& place) -> auto& {
      return parts_[place.part].runs[place.run];
    };
    std::sort(places.begin(), places.end(),
              [&at](const RunAt& a, const RunAt& b) { return at(a).first < at(b).first; });
    std::vector<Answer> answers;
    for (const PeRuns& part : parts_)
      answers.push_back(Answer{part.number, op_, std::vector<std::optional<T>>(part.runs.size())});
    std::optional<T> sum;
    for (const RunAt& place : places) {
      T& value = at(place).second;
      answers[place.part].before[place.run] = sum;
      sum = sum ? combined(op_, std::move(*sum), value) : std::move(value);
    }
    for (std::size_t part = 0; part < parts_.size(); ++part)
      send_to_collection<&ScanPartial::answer_arrives>(pe, collection_, parts_[part].pe,
                                                       std::move(answers[part]));
  }

 private:
  /// The runs of one report of a PE, and the number by which the PE keeps the contributions.
  struct PeRuns {
    PeId pe;
    std::uint64_t number = 0;
    ScanRuns<Types> runs;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(pe, number, runs);
    }
  };
  struct Answer {
    std::uint64_t number = 0;
    Op op;
    std::vector<std::optional<T>> before;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(number, op, before);
    }
  };

  explicit ScanPartial(Reader& ar)
      : op_(ar.take<Op>()),
        collection_(ar.take<CollectionId>()),
        parts_(ar.take<std::vector<PeRuns>>()) {}
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    return std::unique_ptr<Partial>(new ScanPartial(ar));
  }
  static void answer_arrives(Collection& collection, Answer&& answer) {
    const std::unique_ptr<KeptScan> kept = collection.kept_scans().take(answer.number);
    static_cast<Here&>(*kept).give(collection.pe(), answer.op, std::move(answer.before));
  }

  /// The contributions that are collected on this PE.
  Here& open(Collection& collection) {
    if (kept_ == nullptr) {
      auto made = std::make_unique<Here>();
      kept_ = made.get();
      here_ = &collection;
      number_ = collection.kept_scans().add(std::move(made));
    }
    return *kept_;
  }
  static inline const PartialKind kind_{naming::name_of<ScanPartial>(), &unpack};

  [[no_unique_address]] Op op_;
  CollectionId collection_;
  std::vector<PeRuns> parts_;
  Collection* here_ = nullptr;  // while open
  Here* kept_ = nullptr;        // while open, in the list of the collection; null otherwise
  std::uint64_t number_ = 0;    // its number there
};

template <class Key, class Op, class T, class Result>
void contribute_to_scan(const Key& key, const ToArray& to, const Op& scan_op, T value,
                        std::optional<T> first, const Callback<Result>& target) {
  static_assert(std::totally_ordered<Key>,
                "a scan is in the order of indices: give the type of index an operator<=>");
  using Types = ScanTypes<Key, typename ScanOp<Op>::Type, T, Result, ScanOp<Op>::in_runs>;
  using Scan = ScanPartial<Types>;
  if (to.collection.ended()) return;
  check_target(to.element, target);
  Pe& pe = to.collection.pe();
  const typename Types::Op& op = ScanOp<Op>::of(scan_op);
  typename Scan::Here::Contribution one{key, std::move(value), std::move(first),
                                        Counted::sent(pe.completion(), pe.context().epoch), target};
  if (Partial* open = to.open_sum(Scan::its_kind()); open != nullptr) {
    static_cast<Scan*>(open)->add(to.collection, op, std::move(one));
    to.contributed();
  } else {
    auto scan = std::make_unique<Scan>(to.collection, op);
    scan->add(to.collection, op, std::move(one));
    to.contribute(std::move(scan));
  }
}

}  // namespace tess::detail
