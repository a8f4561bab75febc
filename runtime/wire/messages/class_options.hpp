// The names of optional members by which a chare class sets its options. A member that is private,
// or that has another form than the runtime looks for, would be ignored without a word. So each
// name is looked up whatever its access, and a class that has the name in no usable form does not
// compile.
//
// The lookup needs no access: in a class that derives from C and from OptionNames a name that both
// have is ambiguous.
#pragma once

#include <type_traits>

namespace tess::detail {

struct OptionNames {
  struct EntryAttributes;
  int dead_letters, describe_state;
};
template <class C>
struct WithOptionNames : C, OptionNames {
 protected:
  // C may be an interface whose destructor is protected.
  ~WithOptionNames() = default;  // NOLINT(modernize-use-override): C may have no virtual one
};

template <class C>
concept NamesEntryAttributes =
    !std::is_final_v<C> && !requires { typename WithOptionNames<C>::EntryAttributes; };
template <class C>
concept NamesDeadLetters = !std::is_final_v<C> && !requires { &WithOptionNames<C>::dead_letters; };
template <class C>
concept NamesDescribeState =
    !std::is_final_v<C> && !requires { &WithOptionNames<C>::describe_state; };

}  // namespace tess::detail
