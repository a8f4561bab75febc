// How a message shows what somebody has written: in one line, not too long, cut between characters.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace particles {

/// The text with control characters as escapes; " …" stands for what is beyond `longest` bytes.
[[nodiscard]] std::string shown_text(std::string_view text, std::size_t longest = 60);

/// The same of a JSON value. Costs what it shows, however large or deep the value.
[[nodiscard]] std::string shown(const nlohmann::json& value);

}  // namespace particles
