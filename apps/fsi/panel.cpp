#include "apps/fsi/panel.hpp"

#include "apps/kit/charge.hpp"

#include <chrono>
#include <utility>

namespace fsi {
namespace {

constexpr std::chrono::nanoseconds per_point{6};  // and small step, as measured

}  // namespace

Panel::Panel(const Problem& problem)
    : problem_(problem), strip_(problem.n_panel, problem.n_pieces, index().x) {
  for (const Point& p : strip_.points()) guess_.push_back(problem_.exact(p, 0));
  w_.assign(guess_.begin(), guess_.begin() + static_cast<std::ptrdiff_t>(strip_.n_owned()));
  v_.resize(w_.size());
  load_.resize(w_.size());
  w_start_ = w_;
  v_start_ = v_;
}

void Panel::begin() {
  w_start_ = w_;
  v_start_ = v_;
  residual_.clear();
  for (std::size_t i = 0; i < w_.size(); ++i) guess_[i] = w_[i] + problem_.dt() * v_[i];
  send_rows(-1);
}

void Panel::receive(Row row) {
  if (row.number >= 0) return rows_.put(std::move(row));
  if (!row.is_before)
    std::copy(row.values.begin(), row.values.end(),
              guess_.begin() + static_cast<std::ptrdiff_t>(strip_.n_owned()));
}

void Panel::send_rows(std::int32_t number) {
  const std::vector<double>& from = number < 0 ? guess_ : w_;
  const auto row_at = [&](std::size_t first) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(strip_.side()));
  };
  const std::int32_t k = index().x;
  if (!strip_.is_first()) array()[{k - 1}].send<&Panel::receive>(Row{number, false, row_at(0)});
  if (!strip_.is_last())
    array()[{k + 1}].send<&Panel::receive>(
        Row{number, true, row_at(strip_.n_owned() - strip_.side())});
}

double Panel::pull(std::size_t point) const {
  const std::size_t side = strip_.side();
  const double before = point < side ? before_[point] : w_[point - side];
  const double after =
      point + side < w_.size() ? w_[point + side] : after_[point + side - w_.size()];
  return problem_.tension * ((w_[point - 1] - w_[point]) + (w_[point + 1] - w_[point]) +
                             (before - w_[point]) + (after - w_[point]));
}

tess::Task Panel::move() {
  const std::int32_t n = problem_.n_substeps;
  const double step = problem_.dt() / n;
  w_ = w_start_;
  v_ = v_start_;
  for (std::int32_t k = 0;; ++k) {
    send_rows(k);
    for (int i = (strip_.is_first() ? 0 : 1) + (strip_.is_last() ? 0 : 1); i > 0; --i) {
      Row row = co_await rows_.take(k);
      (row.is_before ? before_ : after_) = std::move(row.values);
    }
    for (std::size_t i = 0; i < w_.size(); ++i) {
      if (strip_.is_held(i)) continue;
      const double force = pull(i) + load_[i];
      const double kick = 0.5 * step * force / (problem_.mass * strip_.area(i));
      v_[i] += k == 0 || k == n ? kick : 2 * kick;
    }
    kit::charge(per_point, w_.size());
    if (k == n) co_return;
    for (std::size_t i = 0; i < w_.size(); ++i) w_[i] += step * v_[i];
  }
}

void Panel::compare(tess::Callback<Residual> result) {
  Residual mine;
  const bool is_first = residual_.empty();
  residual_.resize(w_.size());
  for (std::size_t i = 0; i < w_.size(); ++i) {
    const double r = w_[i] - guess_[i], last = std::exchange(residual_[i], r);
    kit::worsen(mine.largest, std::abs(r));
    mine.sums[0].add(r * r);
    if (is_first) continue;
    const double change = r - last;
    mine.sums[1].add(last * change);
    mine.sums[2].add(change * change);
  }
  contribute(JoinResiduals{}, mine, std::move(result));
}

void Panel::correct(double factor) {
  for (std::size_t i = 0; i < w_.size(); ++i) guess_[i] += factor * residual_[i];
  send_rows(-1);
}

void Panel::balance(tess::Callback<Balance> result) {
  contribute(JoinBalances{}, balance_of(strip_, load_, guess_), std::move(result));
}

void Panel::measure(double time, tess::Callback<Measured> result) {
  Measured mine;
  const std::size_t side = strip_.side();
  const auto stretch = [&](double a, double b) {
    mine.energy.add(0.5 * problem_.tension * (a - b) * (a - b));
  };
  // The next piece's first row, as it was at the end of the last move.
  const std::vector<double> beyond =
      after_.empty() ? std::vector<double>(guess_.begin() + std::ssize(w_), guess_.end()) : after_;
  for (std::size_t i = 0; i < w_.size(); ++i) {
    mine.energy.add(0.5 * problem_.mass * strip_.area(i) * v_[i] * v_[i]);
    if ((i + 1) % side != 0) stretch(w_[i], w_[i + 1]);
    if (i + side < guess_.size())
      stretch(w_[i], i + side < w_.size() ? w_[i + side] : beyond[i + side - w_.size()]);
    kit::worsen(mine.error, std::abs(w_[i] - problem_.exact(strip_.points()[i], time)));
    const std::pair<tess::m2m::GlobalId, double> whole{strip_.view().point_ids[i], w_[i]};
    mine.hash += tess::hash_bytes(&whole, sizeof whole);
  }
  contribute(JoinMeasured{}, mine, std::move(result));
}

}  // namespace fsi
