# Writes build.hpp of apps/kit: the version, the preset and the commit that are built. Run at each build; the file
# changes only when they do.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
set(text "#pragma once\n\nnamespace kit {\ninline constexpr const char* version_of_build = \"${VERSION}\";\ninline constexpr const char* preset_of_build = \"${PRESET}\";\ninline constexpr const char* commit_of_build = \"${commit}\";\n}  // namespace kit\n")
if(EXISTS "${OUT}")
  file(READ "${OUT}" before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE "${OUT}" "${text}")
endif()
