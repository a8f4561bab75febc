# Scotch::scotch, the sequential graph partitioner (Debian: libscotch-dev).
find_path(SCOTCH_INCLUDE scotch.h PATH_SUFFIXES scotch)
find_library(SCOTCH_LIBRARY NAMES scotch)
find_library(SCOTCHERR_LIBRARY NAMES scotcherr)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Scotch REQUIRED_VARS SCOTCH_LIBRARY SCOTCHERR_LIBRARY SCOTCH_INCLUDE
  REASON_FAILURE_MESSAGE "Debian: libscotch-dev")
if(Scotch_FOUND AND NOT TARGET Scotch::scotch)
  add_library(Scotch::scotch INTERFACE IMPORTED)
  target_include_directories(Scotch::scotch SYSTEM INTERFACE "${SCOTCH_INCLUDE}")
  target_link_libraries(Scotch::scotch INTERFACE "${SCOTCH_LIBRARY}" "${SCOTCHERR_LIBRARY}")
endif()
mark_as_advanced(SCOTCH_INCLUDE SCOTCH_LIBRARY SCOTCHERR_LIBRARY)
