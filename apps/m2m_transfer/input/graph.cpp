#include "apps/m2m_transfer/input/graph.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

namespace m2m_transfer {
namespace {

/// All positions that a name stands for.
std::vector<std::size_t> positions(const std::string& name,
                                   const std::vector<std::string>& meshes) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    if (meshes[m] == name || name == std::string(1, letter_of(m))) out.push_back(m);
  return out;
}

std::string all_names(const std::vector<std::string>& meshes) {
  std::string out;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    out += (m == 0 ? "" : ", ") + std::string(1, letter_of(m)) + " is " + meshes[m];
  return out;
}

/// Names of meshes may have colons ("kuhn:8"), so every colon may be the one between them.
Pair parse_pair(const std::string& text, const std::vector<std::string>& meshes) {
  std::optional<Pair> found;
  for (std::size_t at = text.find(':'); at != std::string::npos; at = text.find(':', at + 1)) {
    const std::string source = text.substr(0, at), target = text.substr(at + 1);
    if (positions(source, meshes).empty() || positions(target, meshes).empty()) continue;
    const Pair pair{find_mesh(source, meshes, "--pairs"), find_mesh(target, meshes, "--pairs"), 0};
    if (found && *found != pair)
      fail(ErrorCode::bad_argument, "--pairs: '", text,
           "' has two readings; use letters: ", all_names(meshes));
    found = pair;
  }
  if (!found)
    fail(ErrorCode::bad_argument, "--pairs: '", text,
         "' is no pair of these meshes: ", all_names(meshes), "; give pairs such as A:B,B:C");
  if (found->source == found->target)
    fail(ErrorCode::bad_argument, "--pairs: '", text,
         "' has the same mesh twice; give the mesh twice on the command line");
  return *found;
}

bool in_order(const Pair& first, const Pair& second) {
  return first.target == second.target || first.target == second.source ||
         first.source == second.target;
}

}  // namespace

char letter_of(std::size_t mesh) {
  return static_cast<char>('A' + static_cast<char>(std::min<std::size_t>(mesh, 25)));
}

std::size_t find_mesh(const std::string& name, const std::vector<std::string>& meshes,
                      const char* option) {
  const std::vector<std::size_t> found = positions(name, meshes);
  if (found.size() != 1)
    fail(ErrorCode::bad_argument, option, ": '", name, "' is ",
         found.empty() ? "no mesh" : "more than one mesh", "; ", all_names(meshes));
  return found.front();
}

std::vector<Pair> parse_pairs(const std::string& text, const std::vector<std::string>& meshes) {
  if (meshes.size() > 26)
    fail(ErrorCode::bad_argument, meshes.size(), " meshes are given; at most 26 have letters");
  if (text.empty()) return {Pair{}};
  std::vector<Pair> pairs;
  for (const std::string& one : split_at_commas(text)) {
    Pair pair = parse_pair(one, meshes);
    for (const Pair& before : pairs) {
      if (before.source == pair.source && before.target == pair.target)
        fail(ErrorCode::bad_argument, "--pairs: '", one, "' stands twice; leave one of them out");
      if (in_order(before, pair)) pair.level = std::max(pair.level, before.level + 1);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

bool is_written(std::size_t mesh, const std::vector<Pair>& pairs) {
  return std::ranges::any_of(pairs, [mesh](const Pair& p) { return p.target == mesh; });
}

std::string path_of_result(const std::string& path, std::size_t mesh, std::size_t n_meshes,
                           const std::vector<Pair>& pairs) {
  std::size_t n_written = 0;
  for (std::size_t m = 0; m < n_meshes; ++m) n_written += is_written(m, pairs) ? 1U : 0U;
  std::filesystem::path own(path);
  if (n_written > 1)
    own.replace_extension(std::string{'.', letter_of(mesh)} + own.extension().string());
  return own.string();
}

bool needs_values(std::size_t mesh, const std::vector<Pair>& pairs) {
  for (const Pair& pair : pairs) {
    if (pair.source == mesh) return true;
    if (pair.target == mesh) return false;
  }
  return false;
}

bool is_written_after_read(const std::vector<Pair>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = i + 1; j < pairs.size(); ++j)
      if (pairs[j].target == pairs[i].source) return true;
  return false;
}

}  // namespace m2m_transfer
