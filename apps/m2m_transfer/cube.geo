// The unit cube, meshed with edges of any length: gmsh -3 -clmax 0.1 -o cube.msh cube.geo
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
