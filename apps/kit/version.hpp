// This says which build a program is: for --version and for every JSON.
#pragma once

#include <string>

namespace kit {

[[nodiscard]] const char* version();
/// The commit, with "-dirty" for one that was changed; "unknown" outside of a repository.
[[nodiscard]] const char* build_commit();
/// The preset, as "release".
[[nodiscard]] const char* build_preset();
/// "PROGRAM (Tessera) 0.1.0, commit 4f1c2e0, preset release, g++ 12.2.0", a line.
[[nodiscard]] std::string version_text(const std::string& program);

}  // namespace kit
