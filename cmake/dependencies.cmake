# What the project builds on, per component. Everything comes from Debian packages; cmake/setup.sh installs them.
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}/modules")
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)

if("runtime" IN_LIST TESS_COMPONENTS)
  find_package(Boost 1.81 REQUIRED)
  find_package(Hwloc REQUIRED)
  find_package(Brotli REQUIRED)  # files of load balancing
  find_package(nlohmann_json REQUIRED)  # while building only: it has no library
  if(TESS_MPI)
    find_package(MPI REQUIRED COMPONENTS CXX)
  endif()
  find_package(Scotch)
  if(NOT Scotch_FOUND)
    message(STATUS "Tessera: no Scotch, the balance strategy 'graph' is left out")
  endif()
endif()
if("m2m" IN_LIST TESS_COMPONENTS)
  find_package(ExodusII REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(Zoltan REQUIRED)
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # while building only, of one source: it has no library
endif()
if(TESS_APPS AND TESS_TESTS)
  find_package(Catch2 2.13 REQUIRED)
endif()
