// The element types of gmsh's MSH format (gmsh reference manual, section 10.1). Vertices are in the
// order of ExodusII but for the last two of a tet10, and those of a hex27.
#pragma once

#include "m2m/io/elements/split_element.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace tess::m2m {

struct GmshElement {
  int number;
  std::string_view name;
  int dimension;
  int n_vertices;
};

inline constexpr GmshElement gmsh_elements[] = {
    {1, "line2", 1, 2},        {2, "triangle3", 2, 3},    {3, "quad4", 2, 4},
    {4, "tet4", 3, 4},         {5, "hex8", 3, 8},         {6, "prism6", 3, 6},
    {7, "pyramid5", 3, 5},     {8, "line3", 1, 3},        {9, "triangle6", 2, 6},
    {10, "quad9", 2, 9},       {11, "tet10", 3, 10},      {12, "hex27", 3, 27},
    {13, "prism18", 3, 18},    {14, "pyramid14", 3, 14},  {15, "point", 0, 1},
    {16, "quad8", 2, 8},       {17, "hex20", 3, 20},      {18, "prism15", 3, 15},
    {19, "pyramid13", 3, 13},  {20, "triangle9", 2, 9},   {21, "triangle10", 2, 10},
    {22, "triangle12", 2, 12}, {23, "triangle15", 2, 15}, {24, "triangle15i", 2, 15},
    {25, "triangle21", 2, 21}, {26, "line4", 1, 4},       {27, "line5", 1, 5},
    {28, "line6", 1, 6},       {29, "tet20", 3, 20},      {30, "tet35", 3, 35},
    {31, "tet56", 3, 56},      {36, "quad16", 2, 16},     {37, "quad25", 2, 25},
    {38, "quad36", 2, 36},     {92, "hex64", 3, 64},      {93, "hex125", 3, 125},
};

/// The type with this number, or null if there is none.
constexpr const GmshElement* gmsh_element(int number) {
  for (const GmshElement& element : gmsh_elements) {
    if (element.number == number) return &element;
  }
  return nullptr;
}

/// The element of a type number, if it is supported.
constexpr std::optional<ElementType> gmsh_supported(int number) {
  switch (number) {
    case 1:
      return ElementType::edge2;
    case 2:
      return ElementType::tri3;
    case 3:
      return ElementType::quad4;
    case 4:
      return ElementType::tet4;
    case 5:
      return ElementType::hex8;
    case 12:
      return ElementType::hex27;
    case 6:
      return ElementType::wedge6;
    case 7:
      return ElementType::pyramid5;
    case 9:
      return ElementType::tri6;
    case 11:
      return ElementType::tet10;
    default:
      return std::nullopt;
  }
}

/// The vertices of a hex27 of ExodusII in that of gmsh.
inline constexpr std::array<std::size_t, 27> gmsh_hex27{0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                        11, 13, 9,  10, 12, 14, 15, 16, 18,
                                                        19, 17, 26, 20, 25, 22, 23, 21, 24};

}  // namespace tess::m2m
