# What the project builds on. Everything comes from Debian packages; cmake/setup.sh installs them.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Boost 1.81 REQUIRED)
find_package(MPI REQUIRED COMPONENTS C)
find_package(PkgConfig REQUIRED)
pkg_check_modules(hwloc REQUIRED IMPORTED_TARGET hwloc)

# Neither package ships a CMake config in Debian.
find_path(EXODUS_INCLUDE exodusII.h REQUIRED)
find_library(EXODUS_LIBRARY NAMES exoIIv2c exodusII exodus REQUIRED)
add_library(tess_exodus INTERFACE)
target_include_directories(tess_exodus SYSTEM INTERFACE "${EXODUS_INCLUDE}")
target_link_libraries(tess_exodus INTERFACE "${EXODUS_LIBRARY}")

find_path(ZOLTAN_INCLUDE zoltan.h PATH_SUFFIXES trilinos REQUIRED)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan REQUIRED)
add_library(tess_zoltan INTERFACE)
target_include_directories(tess_zoltan SYSTEM INTERFACE "${ZOLTAN_INCLUDE}")
target_link_libraries(tess_zoltan INTERFACE "${ZOLTAN_LIBRARY}" MPI::MPI_C)

# The sequential library: partitions without MPI.
find_path(SCOTCH_INCLUDE scotch.h PATH_SUFFIXES scotch REQUIRED)
find_library(SCOTCH_LIBRARY NAMES scotch REQUIRED)
find_library(SCOTCHERR_LIBRARY NAMES scotcherr REQUIRED)
add_library(tess_scotch INTERFACE)
target_include_directories(tess_scotch SYSTEM INTERFACE "${SCOTCH_INCLUDE}")
target_link_libraries(tess_scotch INTERFACE "${SCOTCH_LIBRARY}" "${SCOTCHERR_LIBRARY}")
