#include "runtime/core/type_name.hpp"

#include <cstddef>
#include <utility>

namespace tess {

namespace {

/// The messages that call what the user did not name as an entry method: "Awakening<Block>" is
/// shown as Block::resume_from_sync.
std::string as_member(const std::string& name) {
  for (const auto& [message, member] :
       {std::pair<std::string_view, std::string_view>{"Awakening<", "resume_from_sync"},
        {"Construction<", "constructor"},
        {"Destruction<", "destroy"},
        {"Relocation<", "migrate_to"}}) {
    if (!name.starts_with(message)) continue;
    int depth = 0;
    std::size_t end = message.size();
    for (; end < name.size() && (depth > 0 || (name[end] != ',' && name[end] != '>')); ++end)
      depth += name[end] == '<' || name[end] == '('   ? 1
               : name[end] == '>' || name[end] == ')' ? -1
                                                      : 0;
    std::string chare = name.substr(message.size(), end - message.size());
    while (chare.ends_with(' ')) chare.pop_back();
    return chare.append("::").append(member);
  }
  return name;
}

}  // namespace

std::string plain_name(std::string_view compiler_name) {
  // "tess::detail::Call<Block, OfEntry, &Block::step>" is shown as Block::step.
  if (const auto function = compiler_name.rfind('&'); function != std::string_view::npos) {
    compiler_name.remove_prefix(function + 1);
    // Find the bracket that closes the part before the name: "&Block<A<int> >::step>".
    int depth = 0;
    std::size_t end = 0;
    for (; end < compiler_name.size(); ++end) {
      const char c = compiler_name[end];
      depth += c == '<' || c == '(' ? 1 : c == '>' || c == ')' ? -1 : 0;
      if (depth < 0) break;
    }
    compiler_name = compiler_name.substr(0, end);
  }
  std::string name(compiler_name);
  for (const std::string_view noise :
       {"{anonymous}::", "(anonymous namespace)::", "tess::detail::", "tess::"}) {
    for (auto at = name.find(noise); at != std::string::npos; at = name.find(noise))
      name.erase(at, noise.size());
  }
  return as_member(name);
}

}  // namespace tess
