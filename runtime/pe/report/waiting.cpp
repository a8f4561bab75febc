#include "runtime/pe/report/waiting.hpp"

#include "runtime/core/text.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace tess::detail {
namespace {

constexpr std::size_t most_of_rank = 20;
constexpr std::size_t most_cycles = 5;

/// Finds cycles by a search in depth: an edge to an element on the present path closes one.
class Cycles {
 public:
  explicit Cycles(const std::vector<Need>& needs) {
    for (const Need& need : needs) {
      edges_[need.asker.key].insert({need.asked.key, need.asked.text});
      names_[need.asker.key] = need.asker.text;
    }
  }
  [[nodiscard]] std::vector<std::string> find() {
    for (const auto& [key, name] : names_) search(key);
    return std::move(found_);
  }

 private:
  struct Step {
    std::string key;
    std::set<std::pair<std::string, std::string>>::const_iterator next, end;
  };

  // Not recursive: a chain of replies may be as long as the array.
  void search(const std::string& from) {
    enter(from);
    while (!path_.empty()) {
      Step& top = path_.back();
      if (top.next == top.end) {
        on_path_.erase(top.key);
        path_.pop_back();
        continue;
      }
      const std::string next = (top.next++)->first;
      if (on_path_.contains(next)) {
        close(next);
      } else {
        enter(next);
      }
    }
  }
  void enter(const std::string& key) {
    const auto at = edges_.find(key);
    if (at == edges_.end() || !seen_.insert(key).second) return;
    path_.push_back({key, at->second.begin(), at->second.end()});
    on_path_.insert(key);
  }
  void close(const std::string& first) {
    std::size_t at = path_.size() - 1;
    while (path_[at].key != first) --at;
    std::string cycle = "cycle of replies: ";
    for (std::size_t i = at; i < path_.size(); ++i)
      cycle += text(i == at ? "" : ", ", names_[path_[i].key], " waits for ",
                    std::prev(path_[i].next)->second);
    found_.push_back(std::move(cycle));
  }

  std::map<std::string, std::set<std::pair<std::string, std::string>>> edges_;
  std::map<std::string, std::string> names_;
  std::set<std::string> seen_, on_path_;
  std::vector<Step> path_;
  std::vector<std::string> found_;
};

}  // namespace

WaitReason::WaitReason(std::string words) : text(std::move(words)) {}

void Waits::add(WaitRank rank, std::string words) {
  if (n_of_rank[static_cast<std::size_t>(rank)]++ < most_kept)
    lines.push_back({rank, std::move(words)});
}

void Waits::merge(Waits&& other) {
  lines.insert(lines.end(), std::make_move_iterator(other.lines.begin()),
               std::make_move_iterator(other.lines.end()));
  needs.insert(needs.end(), std::make_move_iterator(other.needs.begin()),
               std::make_move_iterator(other.needs.end()));
  audit.insert(audit.end(), other.audit.begin(), other.audit.end());
  for (std::size_t rank = 0; rank < n_ranks; ++rank) n_of_rank[rank] += other.n_of_rank[rank];
}

std::uint64_t Waits::size() const {
  return std::accumulate(n_of_rank.begin(), n_of_rank.end(), std::uint64_t{0});
}

std::vector<std::string> cycles_of_replies(const std::vector<Need>& needs) {
  return Cycles(needs).find();
}

std::string list_of_waiting(Waits waits) {
  if (waits.empty()) return "nothing waits";
  std::string list = text(waits.size(), " wait:");
  const std::vector<std::string> cycles = cycles_of_replies(waits.needs);
  for (std::size_t i = 0; i < std::min(most_cycles, cycles.size()); ++i) list += "\n  " + cycles[i];
  if (cycles.size() > most_cycles)
    list += text("\n  … and ", cycles.size() - most_cycles, " more cycles");
  std::sort(waits.lines.begin(), waits.lines.end(), [](const WaitLine& a, const WaitLine& b) {
    return std::tie(a.rank, a.text) < std::tie(b.rank, b.text);
  });
  std::array<std::uint64_t, Waits::n_ranks> n_printed{};
  for (std::size_t i = 0; i < waits.lines.size(); ++i) {
    const auto rank = static_cast<std::size_t>(waits.lines[i].rank);
    if (n_printed[rank] < most_of_rank) {
      list += "\n  " + waits.lines[i].text;
      ++n_printed[rank];
    }
    const bool last = i + 1 == waits.lines.size() || waits.lines[i + 1].rank != waits.lines[i].rank;
    if (const std::uint64_t more = waits.n_of_rank[rank] - n_printed[rank]; last && more != 0)
      list += text("\n  … and ", more, " more like the last one");
  }
  return list;
}

}  // namespace tess::detail
