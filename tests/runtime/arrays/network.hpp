// For tests of one part of a collection without a run: a bag of messages from which a random one is
// delivered next, the counters of epochs, and a result that knows its contributors.
#pragma once

#include "runtime/core/hash.hpp"
#include "runtime/pe/completion/completion.hpp"
#include "runtime/reduce/partial.hpp"

#include <functional>
#include <memory>
#include <typeinfo>
#include <utility>
#include <vector>

namespace tess::test {

/// Messages under way. One that is delivered may post others.
class Bag {
 public:
  explicit Bag(std::uint64_t seed) : random(seed) {}

  void post(std::function<void()> delivery) { under_way_.push_back(std::move(delivery)); }
  [[nodiscard]] bool empty() const { return under_way_.empty(); }
  /// Delivers a random message.
  void deliver_one() {
    std::swap(under_way_[random.below(under_way_.size())], under_way_.back());
    const std::function<void()> delivery = std::move(under_way_.back());
    under_way_.pop_back();
    delivery();
  }

  Random random;

 private:
  std::vector<std::function<void()>> under_way_;
};

/// The Completion of one PE, whose counters a test reads by a wave. It is the only child of PE 0.
class Ledger final : public detail::CompletionMessages {
 public:
  [[nodiscard]] detail::Counters read(EpochId epoch) {
    completion.on(detail::completion::Wave{epoch, PeId{0}, 1});
    return last_;
  }

  detail::Completion completion{*this, PeId{1}, 2};

 private:
  void send(PeId /*to*/, const detail::completion::Report& /*m*/) override {}
  void send(PeId /*to*/, const detail::completion::Answer& /*m*/) override {}
  void send(PeId /*to*/, const detail::completion::Wave& /*m*/) override {}
  void send(PeId /*to*/, const detail::completion::Echo& echo) override { last_ = echo.sum; }
  void send(PeId /*to*/, const detail::completion::End& /*m*/) override {}
  void quiescent() override {}

  detail::Counters last_;
};

/// One ledger per PE.
class Ledgers {
 public:
  explicit Ledgers(std::int32_t n_pes) {
    for (std::int32_t i = 0; i < n_pes; ++i) of_pes_.push_back(std::make_unique<Ledger>());
  }
  [[nodiscard]] detail::Completion& at(PeId pe) {
    return of_pes_[static_cast<std::size_t>(pe.value)]->completion;
  }
  [[nodiscard]] detail::Counters sum(EpochId epoch) {
    detail::Counters sum;
    for (const auto& ledger : of_pes_) sum = sum + ledger->read(epoch);
    return sum;
  }
  /// The number of messages of an epoch that are sent and not processed.
  [[nodiscard]] std::uint64_t n_open(EpochId epoch) {
    const detail::Counters all = sum(epoch);
    return all.sent - all.processed;
  }
  /// The epoch of this number, which PE 0 would coordinate.
  [[nodiscard]] static EpochId epoch(std::uint64_t number) { return EpochId{(number + 1) << 24U}; }

 private:
  std::vector<std::unique_ptr<Ledger>> of_pes_;
};

/// The contributors to a result, in the order in which they were merged.
class Contributors final : public detail::Partial {
 public:
  explicit Contributors(int id) : ids{id} {}
  static const detail::PartialKind& its_kind() {
    static const detail::PartialKind kind({"tess::test::Contributors", &typeid(Contributors)},
                                          nullptr);
    return kind;
  }
  [[nodiscard]] const detail::PartialKind& kind() const override { return its_kind(); }
  void merge(detail::Partial&& other) override {
    const auto& more = static_cast<Contributors&>(other).ids;
    ids.insert(ids.end(), more.begin(), more.end());
  }
  void pack(Writer& /*ar*/) const override {}
  void complete(detail::Pe& /*pe*/) override {}

  std::vector<int> ids;
};

}  // namespace tess::test
