#include "apps/m2m_transfer/study/study.hpp"

#include "m2m/kuhn.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

/// The targets of a ladder without TARGET: for each source the next finer mesh, whose vertices lie
/// anywhere in the tetrahedra of the source.
std::vector<std::string> next_finer(const std::vector<std::string>& sources) {
  std::vector<std::string> targets;
  for (const std::string& source : sources) {
    if (!source.starts_with("kuhn:"))
      fail(ErrorCode::bad_argument,
           "TARGET is missing; only a ladder such as kuhn:8,16,32 implies its targets (--help)");
    const KuhnBox box = parse_kuhn(source);
    targets.push_back(fmt::format("kuhn:{}", box.n + 1));
    if (box.jitter > 0) targets.back() += fmt::format("@{}", box.jitter);
  }
  return targets;
}

void must_exist(const std::string& mesh) {
  std::error_code error;
  if (mesh.starts_with("kuhn:"))
    (void)parse_kuhn(mesh);
  else if (!std::filesystem::exists(mesh, error))
    fail(ErrorCode::bad_file, mesh, ": cannot be opened (no such file); check the path");
}

}  // namespace

std::vector<std::string> expand(const std::string& name) {
  std::error_code error;
  if (name.find(',') == std::string::npos || std::filesystem::exists(name, error)) return {name};
  if (!name.starts_with("kuhn:")) return split_at_commas(name);
  const std::size_t at = std::min(name.find('@'), name.size());
  std::vector<std::string> meshes = split_at_commas(name.substr(5, at - 5));
  for (std::string& mesh : meshes) {
    mesh = "kuhn:" + mesh + name.substr(at);
    (void)parse_kuhn(mesh);
  }
  return meshes;
}

std::vector<Request> plan_study(const Request& request, const std::vector<std::string>& policies,
                                const std::vector<std::string>& kinds) {
  std::vector<std::string> sources = expand(request.source);
  std::vector<std::string> targets =
      request.target.empty() ? next_finer(sources) : expand(request.target);
  if (sources.size() == 1 && targets.size() == 1 && sources != targets) {
    sources.push_back(targets.front());  // also back
    targets.push_back(sources.front());
  }
  const std::size_t n = std::max(sources.size(), targets.size());
  if (sources.size() == 1) sources.resize(n, sources.front());
  if (targets.size() == 1) targets.resize(n, targets.front());
  if (sources.size() != targets.size())
    fail(ErrorCode::bad_argument, "--study: ", sources.size(), " source meshes and ",
         targets.size(), " target meshes; give the same number of both, or one of them");
  std::vector<Request> requests;
  for (std::size_t i = 0; i < n; ++i) {
    must_exist(sources[i]);
    must_exist(targets[i]);
  }
  for (const std::string& kind : kinds)
    for (const std::string& policy : policies) {
      (void)parse_policy(policy);
      for (std::size_t i = 0; i < n; ++i) {
        Request one = request;
        one.source = sources[i];
        one.target = targets[i];
        one.policy = policy;
        one.kind = kind;
        requests.push_back(std::move(one));
      }
    }
  return requests;
}

}  // namespace m2m_transfer
