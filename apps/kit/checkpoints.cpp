#include "apps/kit/checkpoints.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"
#include "runtime/core/text.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <unistd.h>

namespace kit {

void Checkpoints::check(const tess::CommandLine& line, const std::vector<std::string>& of_problem) {
  check_every();
  check_folders();
  for (const char* option : {"--checkpoint-every", "--checkpoint-buddy"})
    if (folder_.empty() && line.is_given(option))
      tess::fail(tess::ErrorCode::bad_argument, option,
                 ": is an option of --checkpoint; give a folder, or leave it out");
  gives_steps_ = line.is_given("--steps");
  for (const std::string& name : of_problem) {
    problem_[name] = line.value(name);
    if (line.is_given(name)) given_[name] = problem_[name];
  }
}

void Checkpoints::check_folders() {
  if (folder_.empty()) return;
  namespace fs = std::filesystem;
  std::error_code none;
  fs::path parent = fs::absolute(folder_, none);  // the first one that is there
  while (!fs::exists(parent, none) && parent != parent.parent_path()) parent = parent.parent_path();
  if (!fs::is_directory(parent, none) || access(parent.c_str(), W_OK) != 0)
    tess::fail(tess::ErrorCode::environment, "--checkpoint ", folder_,
               ": cannot be written: ", parent.string(),
               fs::is_directory(parent, none) ? " is read-only" : " is no folder",
               "; give a folder that can be made");
  // A folder that is missing holds nothing.
  if (restarts() && fs::equivalent(folder_, restart_, none)) return;
  if (const std::string latest = tess::latest_checkpoint(folder_); !latest.empty())
    tess::fail(tess::ErrorCode::bad_argument, "--checkpoint ", folder_, ": holds ", latest,
               " of another run: continue that with --restart ", folder_,
               ", or give an empty folder");
}

void Checkpoints::check_every() {
  const bool by_time = every_.ends_with('s');
  const std::string_view text =
      std::string_view(every_).substr(0, every_.size() - (by_time ? 1 : 0));
  const double number = tess::parse_number<double>(text).value_or(0);
  constexpr double most = 1e9;
  if (!(number > 0 && number <= most) || (!by_time && number != std::floor(number)))
    tess::fail(tess::ErrorCode::bad_argument, "--checkpoint-every: ", every_,
               " is neither a number of steps, as 20, nor of seconds, as 30s");
  if (by_time) {
    period_ = std::chrono::duration<double>(number);
  } else {
    steps_ = static_cast<std::int32_t>(number);
  }
}

std::int32_t Checkpoints::pause_after(std::int32_t step, std::int32_t last) {
  if (folder_.empty()) return last;
  if (steps_ != 0) {
    const std::int64_t next = (static_cast<std::int64_t>(step) / steps_ + 1) * steps_;
    return static_cast<std::int32_t>(std::min<std::int64_t>(next, last));
  }
  // About ten pauses per period, so that a checkpoint is at most a tenth late.
  const auto now = Clock::now();
  const std::chrono::duration<double> took = now - paused_;
  length_ = length_ == 0          ? 1
            : took < period_ / 20 ? std::min(2 * length_, std::int32_t{1} << 28)
            : took > period_ / 10 ? std::max(length_ / 2, 1)
                                  : length_;
  paused_ = now;
  return length_ < last - step ? step + length_ : last;
}

bool Checkpoints::is_due(std::int32_t from, std::int32_t step) {
  if (folder_.empty()) return false;
  if (steps_ != 0) return step / steps_ > from / steps_;
  if (Clock::now() - written_ < period_) return false;
  written_ = Clock::now();
  return true;
}

void Checkpoints::take(Values saved, std::int32_t step, std::int32_t n_steps) {
  for (const auto& [name, value] : given_)
    if (const std::string& was = saved[name]; was != value)
      tess::fail(tess::ErrorCode::bad_argument, name, ": ", value, ", but the checkpoint has ", was,
                 ": leave the option out");
  if (n_steps < step)
    tess::fail(tess::ErrorCode::bad_argument, "--steps: ", n_steps,
               ", but the checkpoint has done ", step);
  problem_ = std::move(saved);
  tess::print("continues after step ", step, "\n");
}

std::string Checkpoints::note_of(std::int32_t step) const {
  std::string note = tess::text("after step ", step);
  for (const auto& [name, value] : problem_) note += tess::text(" ", name, " ", value);
  return note;
}

}  // namespace kit
