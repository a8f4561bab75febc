# Tests that need something that may be missing have a ctest entry of their own, which reports "skipped" then:
#   shared_data   the folder of real meshes beside the project (or TESS_DATA)
#   meshes        meshes that the entry make_meshes generates with gmsh, in the build folder
#   gnuplot       the program
#   vtk           VTK for Python (Debian: python3-vtk9)
#   scipy         NumPy and SciPy, of the Python that the command begins with
set(TESS_MESHES "${CMAKE_BINARY_DIR}/meshes")
set(TESS_NEED_DIR "${CMAKE_CURRENT_LIST_DIR}")

add_test(NAME make_meshes COMMAND bash "${TESS_NEED_DIR}/make_meshes.sh" "${TESS_MESHES}")
set_tests_properties(make_meshes PROPERTIES FIXTURES_SETUP tess_meshes SKIP_RETURN_CODE 77 LABELS unit TIMEOUT 120)

# tess_needing(NAME NEED COMMAND…): a ctest entry that is skipped if the need is missing.
function(tess_needing name need)
  set(location "${TESS_MESHES}")
  if(need STREQUAL "shared_data")
    set(location "${PROJECT_SOURCE_DIR}/../shared/data")
  endif()
  add_test(NAME ${name} COMMAND bash "${TESS_NEED_DIR}/with.sh" ${need} "${location}" ${ARGN})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)
  if(need STREQUAL "meshes")
    set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED tess_meshes)
  endif()
endfunction()

# tess_cases(PROGRAM NEED): an entry for the cases of a test program that are tagged [.][NEED].
function(tess_cases program need)
  if(TARGET ${program})
    tess_needing(${program}_${need} ${need} $<TARGET_FILE:${program}> "[${need}]")
    set_tests_properties(${program}_${need} PROPERTIES LABELS data)
  endif()
endfunction()
