# The three kinds of target: a library, a program, a test. All carry the same options.

add_library(tess_options INTERFACE)
target_compile_features(tess_options INTERFACE cxx_std_20)
target_include_directories(tess_options INTERFACE "${PROJECT_SOURCE_DIR}")
target_compile_options(tess_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  -fno-math-errno -fno-trapping-math -ffp-contract=off)
if(CMAKE_UNITY_BUILD)
  # A source that another includes looks like a header to this warning.
  target_compile_options(tess_options INTERFACE -Wno-subobject-linkage)
endif()
if(WARNINGS_AS_ERRORS)
  target_compile_options(tess_options INTERFACE -Werror)
endif()
if(TESS_NATIVE)
  target_compile_options(tess_options INTERFACE -march=native)
else()
  target_compile_options(tess_options INTERFACE -march=x86-64-v3)
endif()
if(CHECKS STREQUAL "all")
  target_compile_definitions(tess_options INTERFACE TESS_CHECKS_ALL=1)
endif()
if(SANITIZE)
  # Null pointers and sizes of objects the address sanitizer sees by itself; alignment x86 forgives.
  # The three together double the time to compile.
  target_compile_options(tess_options INTERFACE
    -fsanitize=${SANITIZE} -fno-sanitize=null,object-size,alignment -fno-omit-frame-pointer)
  target_link_options(tess_options INTERFACE -fsanitize=${SANITIZE})
endif()

# The runtime's header takes a second to compile, so it is compiled once for all that build on it.
function(tess_reuse_runtime_header name)
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      get_target_property(on_runtime ${library} TESS_ON_RUNTIME)
      if(on_runtime)
        set_target_properties(${name} PROPERTIES TESS_ON_RUNTIME ON)
        target_precompile_headers(${name} REUSE_FROM tess_runtime_header)
        return()
      endif()
    endif()
  endforeach()
endfunction()

# tess_library(NAME SOURCES … HEADERS … DEPENDS …): headers are listed so that a test compiles each alone.
# Sanitizer builds make the libraries that a test needs.
function(tess_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;DEPENDS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES} ${ARG_HEADERS})
    target_link_libraries(${name} PUBLIC tess_options ${ARG_DEPENDS})
    tess_reuse_runtime_header(${name} ${ARG_DEPENDS})
    if(SANITIZE)
      set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE tess_options ${ARG_DEPENDS})
  endif()
  list(TRANSFORM ARG_HEADERS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  set_property(GLOBAL APPEND PROPERTY TESS_HEADERS ${ARG_HEADERS})
  set_property(GLOBAL APPEND PROPERTY TESS_LIBRARIES ${name})
endfunction()

# tess_app(NAME SOURCES … DEPENDS …): a program in bin/. Sanitizer builds leave programs out.
function(tess_app name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tess_options ${ARG_DEPENDS})
  tess_reuse_runtime_header(${name} ${ARG_DEPENDS})
  if(SANITIZE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# tess_test(NAME [TSAN] SOURCES … DEPENDS … LABELS …): a Catch2 program in bin/, run by ctest.
# A test case tagged [.] is hidden: it runs by hand only (soak, seeds, benchmarks).
# TSAN: it has threads, so the thread sanitizer has something to say about it; not about cases tagged [one_thread].
function(tess_test name)
  cmake_parse_arguments(ARG "TSAN" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  if(SANITIZE STREQUAL "thread" AND NOT ARG_TSAN)
    return()
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tess_catch_main ${ARG_DEPENDS})
  target_precompile_headers(${name} REUSE_FROM tess_catch_main)
  if(SANITIZE STREQUAL "thread")
    set(cases "~[one_thread]~[.]")
  endif()
  add_test(NAME ${name} COMMAND ${name} ${cases})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600)
endfunction()
