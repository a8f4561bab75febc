#include "runtime/core/type_name.hpp"

namespace tess {

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
  return name;
}

}  // namespace tess
