// The options of the command line, checked before the first run.
#pragma once

#include "apps/lb_lab/workload/workload.hpp"
#include "runtime/balance_options.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lb_lab {

struct Settings {
  std::vector<std::string> workloads{"linear"};  ///< names, or all
  std::vector<std::int32_t> per_pe{1, 2, 4, 8, 16, 32};
  std::vector<std::string> strategies{"none", "greedy_refine"};  ///< names, or all
  std::vector<std::string> left_out;         ///< strategies of `all` that cannot run, and why
  std::vector<std::uint64_t> memory_limits;  ///< of PEs, in bytes; one: of each; empty: none
  std::int32_t period = 10;                  ///< iterations between rounds
  std::int32_t n_iterations = 50;
  std::string grain = "1ms";  ///< mean work of an element an iteration, at the finest cut
  std::string when = "at_sync";
  std::string prediction = "last";
  std::vector<double> speeds;  ///< of PEs; empty: all 1
  std::uint64_t seed = 1;
  std::uint64_t cell_bytes = 1024;
  std::uint64_t message_bytes = 1024;
  std::int32_t repeat = 1;  ///< runs of each; the fastest counts
  std::string library, plot, snapshots;
  std::string snapshot_format = "json.br";  ///< or json: not compressed
  std::vector<std::string> replay;          ///< files; not empty: no run
  std::int32_t replay_pes = 0;              ///< 0: as in the files
  std::string fold = "block";
};

/// Replaces `all` by names, puts `none` in front of the strategies, and throws tess::Error for
/// settings that cannot be run on that many PEs.
void complete(Settings& settings, std::int32_t n_pes);

/// Throws tess::Error for a name that is no strategy's; `all` may stand among the names.
void require_strategies(const Settings& settings);

/// A limit for each PE, from none, one or all of them. Throws tess::Error for another number.
[[nodiscard]] std::vector<std::uint64_t> limits_of_pes(const Settings& settings, std::size_t n_pes);

/// "250us", "1ms", "0.5s" in seconds, above 0. Throws tess::Error that names the option.
[[nodiscard]] double parse_time(std::string_view option, std::string_view value);

[[nodiscard]] tess::BalanceWhen parse_when(std::string_view value);

/// A workload with these settings, before it is cut.
[[nodiscard]] Problem problem_of(const Settings& settings, std::uint32_t workload,
                                 std::int32_t n_pes);

}  // namespace lb_lab
