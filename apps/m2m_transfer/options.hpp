// The command line of m2m_transfer and of m2m_stability, which carries out --stability: the options,
// and the modes in which each means something.
#pragma once

#include "apps/kit/driver.hpp"
#include "apps/m2m_transfer/file_fields.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer {

/// A run moves formulas by one kind.
struct Mode : kit::Mode {
  static constexpr kit::Modes all_kinds = own(0), files = own(1), from_weights = own(2),
                              round_trips = own(3), steps = own(4), pes = own(5);
};

struct Options {
  FileFieldsRequest request;
  std::vector<std::string> policies{"keep"};
  std::optional<std::int32_t> repeat;  ///< default: 1, in a study 3
  std::string picture;
  std::string reference;
  std::string study;        ///< "h", "kind", "steps" or "pes"; empty: none
  std::string plot;         ///< the folder for files of studies and drift; empty: default
  std::string round_trips;  ///< "1,2,5"
  std::vector<std::int32_t> pes{1, 4, 16, 64, 256};
  std::string sim = "latency=2us,bandwidth=10GB/s";
};

/// Adds all options to `driver`, and sets `options`, which outlive it, from the arguments. Returns
/// false if the help was printed. Throws Error (bad_argument) for what cannot be read, for options
/// that do not work together, and for an output whose path is that of an input or another output.
[[nodiscard]] bool read_options(kit::Driver& driver, Options& options, int argc, char** argv);

}  // namespace m2m_transfer
