// What a suspended coroutine waits for, as awaitables say it. All programs include this header, so
// it is small; waiting.hpp has the rest of the reports.
#pragma once

#include <string>
#include <vector>

namespace tess::detail {

/// An element in reports. The key is unique in the job; the text is for people.
struct NamedElement {
  std::string key;
  std::string text;
};

/// What a suspended coroutine waits for.
struct WaitReason {
  // Implicit: most reasons are a text only.
  WaitReason(std::string words);  // NOLINT(google-explicit-constructor)

  std::string text;
  std::vector<NamedElement> asked;  ///< elements whose replies are all needed
};

}  // namespace tess::detail
