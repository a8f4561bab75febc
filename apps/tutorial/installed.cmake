# Builds the tutorial's programs against an installed Tessera: cmake -S . -B build && cmake --build build
cmake_minimum_required(VERSION 3.25)
project(tessera_examples LANGUAGES CXX)

find_package(Tessera REQUIRED COMPONENTS runtime)
file(GLOB sources CONFIGURE_DEPENDS "*.cpp")
foreach(source IN LISTS sources)
  cmake_path(GET source STEM step)
  add_executable(tutorial_${step} ${source})
  target_link_libraries(tutorial_${step} PRIVATE Tessera::runtime Tessera::command_line Tessera::testing)
endforeach()
