# Zoltan::zoltan, the partitioner (Debian: libtrilinos-zoltan-dev). It needs MPI.
find_path(ZOLTAN_INCLUDE zoltan.h PATH_SUFFIXES trilinos)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Zoltan REQUIRED_VARS ZOLTAN_LIBRARY ZOLTAN_INCLUDE
  REASON_FAILURE_MESSAGE "Debian: libtrilinos-zoltan-dev")
if(Zoltan_FOUND AND NOT TARGET Zoltan::zoltan)
  add_library(Zoltan::zoltan INTERFACE IMPORTED)
  target_include_directories(Zoltan::zoltan SYSTEM INTERFACE "${ZOLTAN_INCLUDE}")
  target_link_libraries(Zoltan::zoltan INTERFACE "${ZOLTAN_LIBRARY}" MPI::MPI_CXX)
endif()
mark_as_advanced(ZOLTAN_INCLUDE ZOLTAN_LIBRARY)
