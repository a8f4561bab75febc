# Writes bench's build.hpp: the preset and the commit that was built. Run at each build; the file
# changes only when they do.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
set(text "#pragma once\n\nnamespace bench {\ninline constexpr const char* build_preset = \"${PRESET}\";\ninline constexpr const char* build_commit = \"${commit}\";\n}  // namespace bench\n")
if(EXISTS "${OUT}")
  file(READ "${OUT}" before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE "${OUT}" "${text}")
endif()
