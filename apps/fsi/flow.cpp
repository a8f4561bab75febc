#include "apps/fsi/flow.hpp"

#include <utility>

namespace fsi {

Flow::Flow(const Problem& problem)
    : problem_(problem), strip_(problem.n_flow, problem.n_pieces, index().x) {
  for (std::size_t i = 0; i < strip_.n_owned(); ++i)
    d_.push_back(problem_.exact(strip_.points()[i], 0));
  force_.resize(strip_.n_points());  // the owners of the others give theirs
  d_start_ = d_;
  v_start_.resize(d_.size());
}

double Flow::velocity(std::size_t point) const {
  return 2 * (d_[point] - d_start_[point]) / problem_.dt() - v_start_[point];
}

void Flow::press() {
  for (std::size_t i = 0; i < d_.size(); ++i)
    force_[i] =
        -problem_.added_mass() * strip_.area(i) * (velocity(i) - v_start_[i]) / problem_.dt();
}

void Flow::accept() {
  for (std::size_t i = 0; i < d_.size(); ++i) v_start_[i] = velocity(i);
  d_start_ = d_;
}

void Flow::balance(tess::Callback<Balance> result) {
  contribute(JoinBalances{}, balance_of(strip_, force_, d_), std::move(result));
}

void Flow::measure(tess::Callback<Measured> result) {
  Measured mine;
  for (std::size_t i = 0; i < d_.size(); ++i) {
    mine.energy.add(0.5 * problem_.added_mass() * strip_.area(i) * v_start_[i] * v_start_[i]);
    const std::pair<tess::m2m::GlobalId, double> whole{strip_.view().point_ids[i], d_[i]};
    mine.hash += tess::hash_bytes(&whole, sizeof whole);
  }
  contribute(JoinMeasured{}, mine, std::move(result));
}

}  // namespace fsi
