// A small program with everything that a checkpoint saves: a dense array that exchanges messages
// and migrates, a sparse array of words that come and go, a group, a single chare, a section. Its
// log depends on every result, and on nothing else: it is the same for every number of PEs and
// schedule.
#pragma once

#include "runtime/checkpoint.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace world {

struct Push {
  std::int32_t step = 0;
  double value = 0;
};

class Atom : public tess::Chare<Atom, tess::Index2> {
 public:
  static constexpr int width = 5, height = 4;

  struct Go {
    std::int32_t step = 0;
    tess::Callback<double> sum;
  };
  tess::Task step(Go go) {
    const tess::Index2 next{(index().x + 1) % width, (index().y + go.step) % height};
    array()[next].send<&Atom::receive>(Push{go.step, value_});
    const tess::Index2 far{(index().x + 2) % width, index().y};
    array()[far].send<&Atom::receive>(Push{go.step, 0.5 * value_});
    double sum = 0;
    for (int n = 0; n < 2; ++n) {
      const Push push = co_await pushes_.take(go.step);
      sum += push.value;  // of two values: the order does not matter
    }
    value_ = 0.25 * value_ + 0.3 * sum + 0.01 * index().x + 1.0 / (3 + index().y);
    contribute(tess::in_order(tess::sum), value_, go.sum);
    const auto n_pes = static_cast<std::uint64_t>(tess::current_pe().n_pes());
    const auto draw =
        tess::mix(static_cast<std::uint64_t>(go.step * 100 + index().x * 10 + index().y));
    if (draw % 3 == 0) migrate_to(tess::PeId{static_cast<std::int32_t>(draw / 3 % n_pes)});
  }
  void receive(Push push) { pushes_.put(push); }

  struct Row {
    tess::SectionProxy<Atom> section;
    tess::Callback<double> sum;
  };
  void sum_row(Row row) { contribute(row.section, tess::in_order(tess::sum), value_, row.sum); }

  void serialize(auto& ar) { ar(value_, pushes_); }

 private:
  double value_ = 1;
  tess::Mailbox<&Push::step> pushes_;
};

class Word : public tess::Chare<Word, std::string> {
 public:
  Word() = default;
  explicit Word(std::int32_t born) : letters_(static_cast<std::size_t>(born), 'a') {}
  void add(char letter) { letters_ += letter; }
  void lengths(tess::Callback<std::int64_t> sum) {
    letters_ += 'x';
    contribute(tess::sum, static_cast<std::int64_t>(letters_.size()), sum);
  }
  void serialize(auto& ar) { ar(letters_); }

 private:
  std::string letters_;
};

class Tally : public tess::Group<Tally> {
 public:
  void add(std::int64_t n) { sum_ += n; }
  void sum(tess::Callback<std::int64_t> target) {
    const std::int32_t n_pes = tess::current_pe().n_pes(), here = tess::current_pe().id().value;
    const bool misplaced =
        std::ranges::any_of(saved_on_, [&](std::int32_t pe) { return pe % n_pes != here; });
    contribute(tess::sum, sum_ + (misplaced ? 1'000'000 : 0), target);
  }
  void absorb(Tally&& other) {
    sum_ += std::exchange(other.sum_, 0);
    saved_on_.insert(saved_on_.end(), other.saved_on_.begin(), other.saved_on_.end());
  }
  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (!Ar::is_reading) saved_on_.assign(1, tess::current_pe().id().value);
    ar(sum_, saved_on_);
  }

 private:
  std::int64_t sum_ = 0;
  std::vector<std::int32_t> saved_on_;  // the PEs of the members in the checkpoint that it is of
};

class Census : public tess::Chare<Census> {
 public:
  void add(std::int64_t n) { seen_.push_back(n); }
  void sum(tess::Callback<std::int64_t> target) {
    std::int64_t sum = static_cast<std::int64_t>(seen_.size());
    for (const std::int64_t n : seen_) sum += n;
    contribute(tess::sum, sum, target);
  }
  void serialize(auto& ar) { ar(seen_); }

 private:
  std::vector<std::int64_t> seen_;
};

/// The state of the main coroutine.
struct State {
  std::int32_t step = 0;
  std::uint64_t log = 0;
  tess::ArrayProxy<Atom> atoms;
  tess::ArrayProxy<Word> words;
  tess::GroupProxy<Tally> tallies;
  tess::ChareProxy<Census> census;
  tess::SectionProxy<Atom> row;
  tess::SectionProxy<Atom> gone;
  tess::ArrayProxy<Word> ended;

  void note(std::int64_t value) { log = tess::mix(log ^ static_cast<std::uint64_t>(value)); }
  void note(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    log = tess::mix(log ^ bits);
  }
  void serialize(auto& ar) { ar(step, log, atoms, words, tallies, census, row, gone, ended); }
};

inline std::string word(std::int32_t step) {
  return "word " + std::to_string(step);
}

inline tess::Task make(State& state) {
  co_await tess::epoch([&state] {
    state.ended = tess::create<Word>(tess::sparse);
    state.atoms = tess::create<Atom>(tess::range(Atom::width, Atom::height));
    state.words = tess::create<Word>(tess::sparse);
    state.tallies = tess::create<Tally>(tess::each_pe);
    state.census = tess::create<Census>(tess::one);
    state.row = tess::create_section(state.atoms, {{3, 1}, {0, 1}, {4, 1}, {2, 1}});
    state.gone = tess::create_section(state.atoms, {{0, 0}});
    state.ended.destroy();
    state.gone.destroy();
  });
}

/// One step; everything that it causes is done when it returns.
inline tess::Task advance(State& state) {
  const std::int32_t step = state.step++;
  co_await tess::epoch([&state, step] {
    state.words[word(step)].insert(step);
    if (step % 3 == 2) state.words[word(step - 2)].destroy();
    const auto n_pes = tess::current_pe().n_pes();
    state.tallies[tess::PeId{step % n_pes}].send<&Tally::add>(step);
    state.census.send<&Census::add>(2 * step);
    // Nothing comes of these: the word was destroyed, the array and the section have ended.
    if (step >= 3) state.words[word(0)].send<&Word::add>('c');
    state.ended["word"].send<&Word::add>('d');
    state.gone.broadcast<&Atom::receive>(Push{});
  });
  tess::Future<double> sum;
  state.atoms.broadcast<&Atom::step>(Atom::Go{step, sum.callback()});
  const double total = co_await sum;
  state.note(total);
  tess::Future<double> of_row;
  state.row.broadcast<&Atom::sum_row>(Atom::Row{state.row, of_row.callback()});
  const double row = co_await of_row;
  state.note(row);
  co_await tess::epoch([&state, step] { state.words[word(step)].send<&Word::add>('b'); });
  tess::Future<std::int64_t> length, tally, census;
  state.words.broadcast<&Word::lengths>(length.callback());
  state.tallies.broadcast<&Tally::sum>(tally.callback());
  state.census.element().send<&Census::sum>(census.callback());
  const std::int64_t n = co_await length, m = co_await tally, k = co_await census;
  state.note(n);
  state.note(m);
  state.note(k);
}

/// Steps `first … last − 1`; a checkpoint after step `at` if it is reached.
inline tess::Task steps(State& state, std::int32_t last) {
  while (state.step < last) co_await advance(state);
}

}  // namespace world
