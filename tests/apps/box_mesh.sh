# box FILE SCALE SHIFT [N]: writes a gmsh mesh of a cube with 6 N cubed tetrahedra (default: N = 3). Scripts source this file.
box() {
  awk -v scale="$2" -v shift="$3" -v n="${4:-3}" 'BEGIN {
    m = n + 1; printf "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", m^3
    for (z = 0; z < m; ++z) for (y = 0; y < m; ++y) for (x = 0; x < m; ++x)
      printf "%d %.17g %.17g %.17g\n", ++v, x / n * scale + shift, y / n * scale + shift, z / n * scale + shift
    printf "$EndNodes\n$Elements\n%d\n", 6 * n^3
    split("0 1 3 7 0 1 5 7 0 2 3 7 0 2 6 7 0 4 5 7 0 4 6 7", corner, " ")
    for (z = 0; z < n; ++z) for (y = 0; y < n; ++y) for (x = 0; x < n; ++x) for (t = 0; t < 6; ++t) {
      printf "%d 4 0", ++e
      for (k = 1; k <= 4; ++k) { c = corner[4 * t + k]; printf " %d", 1 + x + c % 2 + m * (y + int(c / 2) % 2 + m * (z + int(c / 4))) }
      printf "\n"
    }
    print "$EndElements" }' >"$1"
}
