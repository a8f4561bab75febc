# cmake --install: libraries, headers below include/tessera, and a package for find_package(Tessera COMPONENTS …).
include(CMakePackageConfigHelpers)
set(config_folder lib/cmake/Tessera)

install(TARGETS tess_interface EXPORT Tessera_base)
foreach(set base ${TESS_COMPONENTS})
  install(EXPORT Tessera_${set} NAMESPACE Tessera:: DESTINATION ${config_folder})
endforeach()
set(with_scotch ${Scotch_FOUND})
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/TesseraConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/TesseraConfig.cmake" INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/TesseraConfigVersion.cmake"
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/TesseraConfig.cmake" "${PROJECT_BINARY_DIR}/TesseraConfigVersion.cmake"
  DESTINATION ${config_folder})
install(DIRECTORY "${CMAKE_CURRENT_LIST_DIR}/modules" DESTINATION ${config_folder})
