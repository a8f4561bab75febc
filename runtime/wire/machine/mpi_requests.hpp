// MPI requests under way. Each is a part of a transfer: a buffer that is sent or received.
#pragma once

#include "runtime/wire/machine/mpi_session.hpp"

#include <cstddef>
#include <vector>

namespace tess::detail {

/// A transfer counts its incomplete requests in `n_requests`. Used by one thread at a time.
template <class Transfer>
class Requests {
 public:
  [[nodiscard]] std::size_t size() const { return requests_.size(); }

  void add(MPI_Request request, Transfer* transfer) {
    requests_.push_back(request);
    transfers_.push_back(transfer);
    ++transfer->n_requests;
  }

  /// Calls done(transfer) for each transfer whose last part has completed, and forgets these parts.
  template <class Done>
  void poll(Done done) {
    if (requests_.empty()) return;
    int n_complete = 0;
    places_.resize(requests_.size());
    must(MPI_Testsome(static_cast<int>(requests_.size()), requests_.data(), &n_complete,
                      places_.data(), MPI_STATUSES_IGNORE),
         "MPI_Testsome");
    if (n_complete <= 0) return;  // MPI_UNDEFINED is negative
    std::size_t kept = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      if (requests_[i] != MPI_REQUEST_NULL) {
        requests_[kept] = requests_[i];
        transfers_[kept++] = transfers_[i];
      } else if (--transfers_[i]->n_requests == 0) {
        done(transfers_[i]);
      }
    }
    requests_.resize(kept);
    transfers_.resize(kept);
  }

 private:
  std::vector<MPI_Request> requests_;
  std::vector<Transfer*> transfers_;
  std::vector<int> places_;
};

}  // namespace tess::detail
