# The three kinds of target: a library, a program, a test. All are compiled with the same options, of which only
# those that change what a header means are passed on to a project that links the libraries.

add_library(tess_interface INTERFACE)
target_compile_features(tess_interface INTERFACE cxx_std_20)
target_include_directories(tess_interface INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:include/tessera>")
if(TESS_CHECKS STREQUAL "all")
  target_compile_definitions(tess_interface INTERFACE TESS_CHECKS_ALL=1)
endif()

add_library(tess_options INTERFACE)
target_link_libraries(tess_options INTERFACE tess_interface)
# Position-independent, for shared libraries and what is built on the static ones (Python's module). -fPIC stands here for programs, too, since
# the runtime's header is compiled once for all. No name of ours is replaced at load time, so calls within a library stay direct.
target_compile_options(tess_options INTERFACE -fPIC -fno-semantic-interposition
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  -fno-math-errno -fno-trapping-math -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ collects its garbage only from a gigabyte on, which saves a tenth of its time.
  target_compile_options(tess_options INTERFACE --param=ggc-min-heapsize=1000000)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # A source that another includes looks like a header to this warning.
  target_compile_options(tess_options INTERFACE -Wno-subobject-linkage)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Loops over lanes combine comparisons without branches.
  target_compile_options(tess_options INTERFACE -Wno-bitwise-instead-of-logical)
  if(CMAKE_UNITY_BUILD)
    # A name at the top of one source is not around the others that are compiled with it.
    target_compile_options(tess_options INTERFACE -Wno-shadow)
  endif()
endif()
if(TESS_WARNINGS_AS_ERRORS)
  target_compile_options(tess_options INTERFACE -Werror)
endif()
if(TESS_NATIVE)
  target_compile_options(tess_options INTERFACE -march=native)
endif()
if(TESS_SANITIZE)
  # Null pointers and sizes of objects the address sanitizer sees by itself; alignment x86 forgives.
  # The three together double the time to compile.
  target_compile_options(tess_options INTERFACE
    -fsanitize=${TESS_SANITIZE} -fno-sanitize=null,object-size,alignment -fno-omit-frame-pointer)
  target_link_options(tess_options INTERFACE -fsanitize=${TESS_SANITIZE})
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

# tess_library(NAME SOURCES … HEADERS … DEPENDS … USES … USES_TO_BUILD …): headers are listed so that a test compiles
# each alone (not those of programs) and that they are installed. DEPENDS stand in the headers, USES in the sources only, and USES_TO_BUILD have
# no library that a program would link. A library of a component (TESS_COMPONENT) is installed if TESS_INSTALL is set, and shared if
# BUILD_SHARED_LIBS is; those of programs are static. Sanitizer builds make the libraries that a test needs.
function(tess_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;DEPENDS;USES;USES_TO_BUILD" ${ARGN})
  list(TRANSFORM ARG_HEADERS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  if(ARG_SOURCES)
    set(scope PUBLIC)
    set(kind STATIC)
    if(BUILD_SHARED_LIBS AND TESS_COMPONENT)
      set(kind SHARED)
    endif()
    add_library(${name} ${kind} ${ARG_SOURCES})
    # Compiled alike in both kinds.
    set_target_properties(${name} PROPERTIES DEFINE_SYMBOL "" POSITION_INDEPENDENT_CODE OFF
      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    target_link_libraries(${name} PUBLIC tess_interface ${ARG_DEPENDS}
      PRIVATE ${ARG_USES} $<BUILD_INTERFACE:tess_options> $<BUILD_INTERFACE:${ARG_USES_TO_BUILD}>)
    tess_reuse_runtime_header(${name} ${ARG_DEPENDS})
    if(TESS_SANITIZE OR NOT TESS_INSTALL)
      set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    endif()
  else()
    set(scope INTERFACE)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE tess_interface ${ARG_DEPENDS})
  endif()
  list(TRANSFORM ARG_HEADERS REPLACE "/[^/]+/\\.\\./" "/")
  target_sources(${name} ${scope} FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${ARG_HEADERS})
  if(TESS_COMPONENT AND TESS_INSTALL)
    install(TARGETS ${name} EXPORT Tessera_${TESS_COMPONENT} ARCHIVE COMPONENT dev LIBRARY COMPONENT bin NAMELINK_COMPONENT dev
      FILE_SET HEADERS DESTINATION include/tessera COMPONENT dev)
  endif()
  list(FILTER ARG_SOURCES EXCLUDE REGEX "^/")  # generated
  list(TRANSFORM ARG_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  set_property(GLOBAL APPEND PROPERTY TESS_HEADERS ${ARG_HEADERS})
  set_property(GLOBAL APPEND PROPERTY TESS_SOURCES ${ARG_SOURCES})
  set_property(GLOBAL APPEND PROPERTY TESS_LIBRARIES ${name} ${ARG_USES} ${ARG_USES_TO_BUILD})
endfunction()

# tess_registers(LIBRARY SYMBOL): no program calls it by name; the linker takes it for this symbol of what registers it.
function(tess_registers library symbol)
  target_link_options(${library} INTERFACE "LINKER:--undefined=${symbol}")
  if(BUILD_SHARED_LIBS)
    target_link_options(${library} INTERFACE "LINKER:--no-as-needed")
  endif()
endfunction()

# tess_export(NAME LIBRARY): Tessera::NAME is this library and all that it stands on; for pkg-config it is tessera-NAME.
function(tess_export name library)
  add_library(Tessera::${name} ALIAS ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY TESS_EXPORTED ${name})
endfunction()

# tess_program(NAME SOURCES … DEPENDS …): a program in bin/.
function(tess_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tess_options ${ARG_DEPENDS})
  tess_reuse_runtime_header(${name} ${ARG_DEPENDS})
endfunction()

# tess_app(NAME SOURCES … DEPENDS …): the same for programs of users, which are installed, but for those of the tutorial, and
# which sanitizer builds leave out.
function(tess_app name)
  tess_program(${name} ${ARGN})
  if(TESS_SANITIZE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  elseif(TESS_INSTALL AND NOT name MATCHES "^tutorial_")
    install(TARGETS ${name} RUNTIME DESTINATION bin COMPONENT bin)
  endif()
endfunction()

# Options of code whose speed is of no concern, so that it compiles fast. At -O1 g++ 12 takes bytes of short strings for
# uninitialised.
set(TESS_COMPILES_FAST $<$<CONFIG:Release>:-O1> $<$<CONFIG:Release>:-Wno-maybe-uninitialized>)

# tess_not_timed(LIBRARY…): it has these options; it reads options, writes reports, draws pictures.
function(tess_not_timed)
  foreach(library IN LISTS ARGN)
    target_compile_options(${library} PRIVATE ${TESS_COMPILES_FAST})
  endforeach()
endfunction()

# tess_tier(TIER TEST PROGRAM…): the tier (quick, sanitized) of tests/run.sh builds these programs and runs this test.
function(tess_tier tier test)
  set_property(TEST ${test} APPEND PROPERTY LABELS ${tier})
  if(NOT TARGET ${tier}_tests)
    add_custom_target(${tier}_tests)
  endif()
  if(ARGN)
    add_dependencies(${tier}_tests ${ARGN})
  endif()
endfunction()

# tess_test(NAME [TSAN] [QUICK] [SANITIZED] SOURCES … DEPENDS … LABELS …): a Catch2 program in bin/, run by ctest.
# A test case tagged [.] is hidden: it runs by hand only (soak, seeds, benchmarks).
# TSAN: it has threads, so the thread sanitizer has something to say about it; not about cases tagged [one_thread].
# QUICK: it belongs to the quick tier, since planted bugs are found by it (tests/mutants/); SANITIZED: there it runs once more with
# the address and undefined-behaviour sanitizers, in which everything takes twice as long to compile and four times to run.
function(tess_test name)
  cmake_parse_arguments(ARG "TSAN;QUICK;SANITIZED" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  if(TESS_SANITIZE STREQUAL "thread" AND NOT ARG_TSAN)
    return()
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tess_catch_main ${ARG_DEPENDS})
  target_precompile_headers(${name} REUSE_FROM tess_catch_main)
  if(TESS_SANITIZE STREQUAL "thread")
    set(cases "~[one_thread]~[.]")
  endif()
  add_test(NAME ${name} COMMAND ${name} ${cases})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600)
  if(ARG_QUICK)
    tess_tier(quick ${name} ${name})
  endif()
  if(ARG_SANITIZED)
    tess_tier(sanitized ${name} ${name})
  endif()
endfunction()
