# Brotli::brotli, compression of files: encoder and decoder (Debian: libbrotli-dev).
find_path(BROTLI_INCLUDE brotli/decode.h)
find_library(BROTLIENC_LIBRARY NAMES brotlienc)
find_library(BROTLIDEC_LIBRARY NAMES brotlidec)
find_library(BROTLICOMMON_LIBRARY NAMES brotlicommon)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Brotli
  REQUIRED_VARS BROTLIENC_LIBRARY BROTLIDEC_LIBRARY BROTLICOMMON_LIBRARY BROTLI_INCLUDE
  REASON_FAILURE_MESSAGE "Debian: libbrotli-dev")
if(Brotli_FOUND AND NOT TARGET Brotli::brotli)
  add_library(Brotli::brotli INTERFACE IMPORTED)
  target_include_directories(Brotli::brotli SYSTEM INTERFACE "${BROTLI_INCLUDE}")
  target_link_libraries(Brotli::brotli INTERFACE
    "${BROTLIENC_LIBRARY}" "${BROTLIDEC_LIBRARY}" "${BROTLICOMMON_LIBRARY}")
endif()
mark_as_advanced(BROTLI_INCLUDE BROTLIENC_LIBRARY BROTLIDEC_LIBRARY BROTLICOMMON_LIBRARY)
