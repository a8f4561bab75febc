// A broadcast of an int that every element answers by contributing it; the sum goes to one element,
// which starts the next round.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/more/section.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

struct Rounds {
  std::int32_t n = 0;
  std::int32_t n_elements = 0;
  tess::Callback<std::int32_t> done;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n, n_elements, done);
  }
};

template <class Index>
class Voter : public tess::Chare<Voter<Index>, Index> {
 public:
  void vote(std::int32_t value) {
    this->contribute(tess::sum, value, this->array()[Index{}].template target<&Voter::next>());
  }
  /// To the first element: it conducts.
  void begin(Rounds rounds) {
    rounds_ = std::move(rounds);
    value_ = 1;
    this->array().template broadcast<&Voter::vote>(value_);
  }
  void next(std::int32_t sum) {
    TESS_CHECK(sum == value_ * rounds_.n_elements, rounds_.n_elements, " votes of ", value_,
               " add up to ", sum);
    if (value_ == rounds_.n)
      rounds_.done(value_);
    else
      this->array().template broadcast<&Voter::vote>(++value_);
  }

 private:
  std::int32_t value_ = 0;
  Rounds rounds_;
};

using DenseVoters = tess::ArrayProxy<Voter<tess::Index1>>;
using SparseVoters = tess::ArrayProxy<Voter<tess::Index3>>;

/// Fills a sparse array: each PE inserts its share of n elements.
class Registrar : public tess::Group<Registrar> {
 public:
  void fill(SparseVoters voters, std::int64_t n) {
    const std::int64_t me = pe().value, n_pes = tess::n_pes();
    fill_from({voters, n * me / n_pes, n * (me + 1) / n_pes});
  }

 private:
  struct Part {
    SparseVoters voters;
    std::int64_t next = 0, last = 0;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(voters, next, last);
    }
  };
  void fill_from(Part part) {
    const std::int64_t end = std::min(part.last, part.next + 100);
    for (; part.next < end; ++part.next) {
      const auto i = static_cast<std::int32_t>(part.next);
      part.voters[{i % 100, i / 100 % 100, i / 10'000}].insert();
    }
    if (part.next < part.last) group()[pe()].send<&Registrar::fill_from>(part);
  }
};

/// `begin` sends the rounds to the element that conducts them.
template <class Begin>
tess::Task hold_votes(const Bench& bench, Begin begin, std::int32_t n_voters, Samples& samples) {
  std::int32_t n_rounds = 2;
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    tess::Future<std::int32_t> done;
    const Stopwatch watch;
    begin(Rounds{n_rounds, n_voters, done.callback()});
    const std::int32_t last = co_await done;
    const double nanoseconds = watch.nanoseconds() / n_rounds;
    TESS_CHECK(last == n_rounds, last, " rounds were held, not ", n_rounds);
    if (turn == 0)
      n_rounds = static_cast<std::int32_t>(times_in_sample(nanoseconds, bench.size(200, 3)));
    else
      samples.add(nanoseconds / n_voters);
  }
}

tess::Task measure_dense(const Bench& bench, std::int32_t n_elements, Samples& samples) {
  const DenseVoters voters = tess::create<Voter<tess::Index1>>(tess::range(n_elements));
  const auto begin = [voters](Rounds rounds) {
    voters[{0}].send<&Voter<tess::Index1>::begin>(std::move(rounds));
  };
  co_await hold_votes(bench, begin, n_elements, samples);
}

tess::Task measure_sparse(const Bench& bench, std::int32_t n_elements, Samples& samples) {
  const SparseVoters voters = tess::create<Voter<tess::Index3>>(tess::sparse);
  const auto registrar = tess::create<Registrar>(tess::each_pe);
  const auto fill = [&] { registrar.broadcast<&Registrar::fill>(voters, n_elements); };
  co_await tess::epoch(fill);
  const auto begin = [voters](Rounds rounds) {
    voters[{0, 0, 0}].send<&Voter<tess::Index3>::begin>(std::move(rounds));
  };
  co_await hold_votes(bench, begin, n_elements, samples);
}

/// The members of a section hold the votes.
class Chorister : public tess::Chare<Chorister> {
 public:
  void vote(std::int32_t value) {
    contribute(section_, tess::sum, value, section_first_.target<&Chorister::next>());
  }
  void join(tess::SectionProxy<Chorister> section) {
    section_ = section;
    section_first_ = array()[{0}];
  }
  void begin(Rounds rounds) {
    rounds_ = std::move(rounds);
    value_ = 1;
    section_.broadcast<&Chorister::vote>(value_);
  }
  void next(std::int32_t sum) {
    TESS_CHECK(sum == value_ * rounds_.n_elements, rounds_.n_elements, " votes of ", value_,
               " add up to ", sum);
    if (value_ == rounds_.n)
      rounds_.done(value_);
    else
      section_.broadcast<&Chorister::vote>(++value_);
  }

 private:
  tess::SectionProxy<Chorister> section_;
  tess::ElementProxy<Chorister, tess::Index1> section_first_;
  std::int32_t value_ = 0;
  Rounds rounds_;
};

/// Every hundredth of the elements is a member.
tess::Task measure_section(const Bench& bench, std::int32_t n_elements, Samples& samples) {
  const auto all = tess::create<Chorister>(tess::range(n_elements));
  const std::int32_t n_members = n_elements / 100;
  tess::SectionProxy<Chorister> section;
  const auto make = [&] {
    section = tess::create_section_if(all, [](tess::Index1 index) { return index.x % 100 == 0; });
    all.broadcast<&Chorister::join>(section);
  };
  co_await tess::epoch(make);
  const auto begin = [all](Rounds rounds) { all[{0}].send<&Chorister::begin>(std::move(rounds)); };
  co_await hold_votes(bench, begin, n_members, samples);
}

/// The elements of a full run, and of a quick one.
struct VoteRow {
  const char* name;
  const char* meaning;
  tess::Task (*measure)(const Bench&, std::int32_t n_elements, Samples&);
  std::int32_t n, n_quick;
};
constexpr VoteRow rows[] = {
    {"broadcast_sum_1k", "1 000 elements of a dense array", &measure_dense, 1000, 100},
    {"broadcast_sum_10k", "10 000 elements of a dense array", &measure_dense, 10'000, 1000},
    {"section_sum_100_of_10k", "a section of 100 of the 10 000 elements", &measure_section, 10'000,
     1000},
    {"broadcast_sum_100k", "100 000 elements of a dense array", &measure_dense, 100'000, 1000},
    {"broadcast_sum_1M_sparse", "10^6 elements of a sparse array", &measure_sparse, 1'000'000,
     2000}};

int run_collectives(Bench& bench) {
  for (const VoteRow& row : rows) {
    if (!bench.wants(row.name)) continue;
    Samples samples;
    const int code =
        bench.run([&] { return row.measure(bench, bench.size(row.n, row.n_quick), samples); });
    if (code != 0) return code;
    bench.row(row.name, samples, "ns");
  }
  return 0;
}

}  // namespace

Shape collectives_shape() {
  Shape shape{"collectives",
              "broadcast of an int that all contribute, the sum starts the next of 200 rounds, "
              "elapsed time over rounds and elements",
              {},
              nullptr,
              &run_collectives};
  for (const VoteRow& row : rows) shape.rows.push_back({row.name, row.meaning});
  return shape;
}

}  // namespace bench
