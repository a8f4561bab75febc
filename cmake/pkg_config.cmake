# Files for pkg-config. The libraries are static, so a file names all that stands below its own, each before those that it needs.

# tess_visit(TARGET): puts it before `tess_order`, or what it links that is not of ours behind `tess_others`, once each.
function(tess_visit target)
  if(target MATCHES "^\\$<LINK_ONLY:(.*)>$")
    set(target ${CMAKE_MATCH_1})
  endif()
  if(target MATCHES "^(\\$<BUILD_INTERFACE|::@)" OR target IN_LIST tess_seen)
    return()
  endif()
  list(APPEND tess_seen ${target})
  if(TARGET ${target})
    get_target_property(kind ${target} TYPE)
    get_target_property(below ${target} INTERFACE_LINK_LIBRARIES)
    if(below)
      foreach(one IN LISTS below)
        tess_visit("${one}")
      endforeach()
    endif()
    if(target MATCHES "^tess_" AND NOT kind STREQUAL "INTERFACE_LIBRARY")
      list(PREPEND tess_order -l${target})
    elseif(NOT kind STREQUAL "INTERFACE_LIBRARY")
      list(PREPEND tess_others $<TARGET_LINKER_FILE:${target}>)
    endif()
  else()  # a file, an option, or the name of a library
    string(REGEX REPLACE "^([a-z0-9_]+)$" "-l\\1" target "${target}")
    list(APPEND tess_others ${target})
  endif()
  set(tess_seen ${tess_seen} PARENT_SCOPE)
  set(tess_order ${tess_order} PARENT_SCOPE)
  set(tess_others ${tess_others} PARENT_SCOPE)
endfunction()

# tess_pkg_config(NAME): installs tessera-NAME.pc for Tessera::NAME.
function(tess_pkg_config name)
  set(tess_seen)
  set(tess_order)
  set(tess_others)
  get_target_property(library Tessera::${name} ALIASED_TARGET)
  tess_visit(${library})
  get_target_property(options ${library} INTERFACE_LINK_OPTIONS)
  if(options)
    string(REPLACE "LINKER:" "-Wl," options "${options}")
    list(PREPEND tess_order ${options})
  endif()
  set(flags "-I\${prefix}/include/tessera")
  if(TESS_CHECKS STREQUAL "all")
    string(APPEND flags " -DTESS_CHECKS_ALL=1")
  endif()
  foreach(folder IN LISTS Boost_INCLUDE_DIRS)
    if(NOT folder STREQUAL "/usr/include")
      string(APPEND flags " -I${folder}")
    endif()
  endforeach()
  string(REPLACE ";" " " libraries "${tess_order};${tess_others};-pthread")
  set(file "${PROJECT_BINARY_DIR}/pkgconfig/tessera-${name}.pc")
  file(GENERATE OUTPUT "${file}" CONTENT
"prefix=\${pcfiledir}/../..
Name: tessera-${name}
Description: Tessera, a message-driven runtime in C++20: ${name}
Version: ${PROJECT_VERSION}
Cflags: ${flags}
Libs: -L\${prefix}/lib ${libraries}
")
  install(FILES "${file}" DESTINATION lib/pkgconfig COMPONENT dev)
endfunction()
