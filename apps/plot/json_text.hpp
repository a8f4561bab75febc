// JSON as it is written to files.
#pragma once

#include <string>

namespace plot {

/// The text of a value of nlohmann's library, with a line end. Bytes that are no UTF-8, as names of
/// files may have, become U+FFFD: the library would throw after all the work is done.
template <class Json>
[[nodiscard]] std::string json_text(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plot
