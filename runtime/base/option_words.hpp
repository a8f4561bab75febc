// The words of a command line that are options, and the refusal of those that the program lacks.
#pragma once

#include <string>
#include <string_view>

namespace tess::detail {

/// "-x" and "--x", not "-", "-1" and "-.5".
[[nodiscard]] bool looks_like_option(std::string_view word);

/// "--steps" of "--steps=5".
[[nodiscard]] std::string name_in(std::string_view word);

/// Throws tess::Error with the nearest of the options that the text of --help lists.
[[noreturn]] void refuse_unknown_option(const std::string& name, std::string_view help);

}  // namespace tess::detail
