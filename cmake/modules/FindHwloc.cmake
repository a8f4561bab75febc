# Hwloc::hwloc, the topology of cores (Debian: libhwloc-dev).
find_path(HWLOC_INCLUDE hwloc.h)
find_library(HWLOC_LIBRARY NAMES hwloc)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Hwloc REQUIRED_VARS HWLOC_LIBRARY HWLOC_INCLUDE
  REASON_FAILURE_MESSAGE "Debian: libhwloc-dev")
if(Hwloc_FOUND AND NOT TARGET Hwloc::hwloc)
  add_library(Hwloc::hwloc INTERFACE IMPORTED)
  target_include_directories(Hwloc::hwloc SYSTEM INTERFACE "${HWLOC_INCLUDE}")
  target_link_libraries(Hwloc::hwloc INTERFACE "${HWLOC_LIBRARY}")
endif()
mark_as_advanced(HWLOC_INCLUDE HWLOC_LIBRARY)
