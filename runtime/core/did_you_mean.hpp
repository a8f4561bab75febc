// A word that was mistyped, and the name that was meant: for refusals of options and of choices.
#pragma once

#include <string>
#include <string_view>

namespace tess {

/// The nearest of these names, which may be separated by anything that stands in no name, as in
/// "linear, second-order" and "-h,--help"; empty if none is near.
[[nodiscard]] std::string nearest_name(std::string_view word, std::string_view names);

/// "; did you mean linear?", for the end of a refusal; empty if no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::string_view names);

}  // namespace tess
