# ExodusII::exodus, the mesh file library (Debian: libexodusii-dev), which ships no CMake file there.
# Linked with it is the NetCDF library that it was linked with: another one does not know its files.
find_path(EXODUSII_INCLUDE exodusII.h)
find_library(EXODUSII_LIBRARY NAMES exoIIv2c exodusII exodus)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ExodusII REQUIRED_VARS EXODUSII_LIBRARY EXODUSII_INCLUDE
  REASON_FAILURE_MESSAGE "Debian: libexodusii-dev")
if(ExodusII_FOUND AND NOT TARGET ExodusII::exodus)
  add_library(ExodusII::exodus INTERFACE IMPORTED)
  target_include_directories(ExodusII::exodus SYSTEM INTERFACE "${EXODUSII_INCLUDE}")
  target_link_libraries(ExodusII::exodus INTERFACE
    -Wl,--copy-dt-needed-entries "${EXODUSII_LIBRARY}" -Wl,--no-copy-dt-needed-entries)
endif()
mark_as_advanced(EXODUSII_INCLUDE EXODUSII_LIBRARY)
