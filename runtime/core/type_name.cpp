#include "runtime/core/type_name.hpp"

#include <cstddef>
#include <utility>

namespace tess {

namespace {

/// Where the template argument that begins here ends: at a comma or a bracket that is none of its
/// own, as in "Block<A<int> >::step>".
std::size_t end_of_argument(std::string_view text, std::size_t begin = 0) {
  int depth = 0;
  for (std::size_t at = begin; at < text.size(); ++at) {
    const char c = text[at];
    if (depth == 0 && (c == ',' || c == '>' || c == ')')) return at;
    depth += c == '<' || c == '(' ? 1 : c == '>' || c == ')' ? -1 : 0;
  }
  return text.size();
}

/// The messages that call what the user did not name as an entry method: "Awakening<Block>" is
/// shown as Block::resume_from_sync.
std::string as_member(const std::string& name) {
  for (const auto& [message, member] :
       {std::pair<std::string_view, std::string_view>{"Awakening<", "resume_from_sync"},
        {"Construction<", "constructor"},
        {"Destruction<", "destroy"},
        {"Relocation<", "migrate_to"}}) {
    if (!name.starts_with(message)) continue;
    const std::size_t begin = message.size();
    std::string chare = name.substr(begin, end_of_argument(name, begin) - begin);
    while (chare.ends_with(' ')) chare.pop_back();
    return chare.append("::").append(member);
  }
  return name;
}

/// The function in "tess::detail::Call<Block, OfEntry, &Block::step>": Block::step.
std::string_view function_in(std::string_view name) {
  const auto function = name.rfind('&');
  if (function == std::string_view::npos) return name;
  name.remove_prefix(function + 1);
  return name.substr(0, end_of_argument(name));
}

/// Without namespaces that say nothing.
std::string without_noise(std::string_view compiler_name) {
  std::string name(compiler_name);
  for (const std::string_view noise :
       {"{anonymous}::", "(anonymous namespace)::", "tess::detail::", "tess::"}) {
    for (auto at = name.find(noise); at != std::string::npos; at = name.find(noise))
      name.erase(at, noise.size());
  }
  return name;
}

}  // namespace

bool is_of_runtime(std::string_view compiler_name) {
  const std::string_view function = function_in(compiler_name);
  const std::string name = without_noise(function);
  return function.starts_with("tess::") && as_member(name) == name;
}

std::string plain_name(std::string_view compiler_name) {
  return as_member(without_noise(function_in(compiler_name)));
}

}  // namespace tess
