// An element of a laboratory run: iterates on its block, sends its edges to its neighbours where
// the workload has traffic, and calls at_sync() once per phase. Workers run ahead of each other as
// far as their neighbours and the barrier allow.
#pragma once

#include "apps/lb_lab/run/station.hpp"
#include "apps/lb_lab/workload/patch.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lb_lab {

/// A neighbour's edge in one iteration, and ballast.
struct Edge {
  std::int32_t iteration = 0;
  Side side{};
  std::vector<std::uint64_t> states;
  std::vector<std::uint8_t> ballast;
};

class Worker : public tess::Chare<Worker, tess::Index1> {
 public:
  Worker() = default;
  explicit Worker(tess::GroupProxy<Station> stations);

  // Entry methods.
  void begin(tess::Callback<std::uint64_t> answer);
  tess::Task iterate();
  void receive(Edge edge) { edges_.put(std::move(edge)); }

  /// For the balancer.
  void resume_from_sync();
  [[nodiscard]] std::array<double, 3> balance_position() const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(stations_, answer_, patch_, edges_, iteration_);
  }

 private:
  [[nodiscard]] Station& station() const { return stations_.local(); }
  [[nodiscard]] const Plan& plan() const { return station().plan(); }
  std::size_t send_edges();
  void compute();
  void go_on();

  tess::GroupProxy<Station> stations_;
  tess::Callback<std::uint64_t> answer_;
  Patch patch_;
  tess::Mailbox<&Edge::iteration> edges_;
  std::int32_t iteration_ = 0;
};

}  // namespace lb_lab
