# cmake --install: libraries, headers below include/tessera, a package for find_package(Tessera COMPONENTS …), files for pkg-config,
# and the tutorial as examples. Programs are installed by tess_app(). Components: bin (programs), dev (the rest).
include(CMakePackageConfigHelpers)
include("${CMAKE_CURRENT_LIST_DIR}/pkg_config.cmake")
set(config_folder lib/cmake/Tessera)

install(TARGETS tess_interface EXPORT Tessera_base)
foreach(set base ${TESS_COMPONENTS})
  install(EXPORT Tessera_${set} NAMESPACE Tessera:: DESTINATION ${config_folder} COMPONENT dev)
endforeach()
set(with_scotch ${Scotch_FOUND})
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/TesseraConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/TesseraConfig.cmake" INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/TesseraConfigVersion.cmake"
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/TesseraConfig.cmake" "${PROJECT_BINARY_DIR}/TesseraConfigVersion.cmake"
  DESTINATION ${config_folder} COMPONENT dev)
install(DIRECTORY "${CMAKE_CURRENT_LIST_DIR}/modules" DESTINATION ${config_folder} COMPONENT dev)

get_property(exported GLOBAL PROPERTY TESS_EXPORTED)
foreach(name IN LISTS exported)
  tess_pkg_config(${name})
endforeach()

set(tutorial "${PROJECT_SOURCE_DIR}/apps/tutorial")
install(DIRECTORY "${tutorial}/" DESTINATION share/doc/tessera/examples COMPONENT dev FILES_MATCHING PATTERN "*.cpp" PATTERN "README.md")
install(FILES "${tutorial}/installed.cmake" DESTINATION share/doc/tessera/examples RENAME CMakeLists.txt COMPONENT dev)
