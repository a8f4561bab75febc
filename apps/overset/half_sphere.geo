// Half a ball on the plane of symmetry z = 0: part 1 is the background, part 2 the mesh around the ball.
//     gmsh -3 -setnumber part 1 -o background.msh half_sphere.geo
//     gmsh -3 -setnumber part 2 -o half_sphere.msh half_sphere.geo
SetFactory("OpenCASCADE");
DefineConstant[ part = 1, h = 0.17, radius = 0.4, outer = 0.8 ];
If (part == 1)
  Box(1) = {-1.2, -1, 0, 2.4, 2, 1.2};
Else
  Sphere(1) = {0, 0, 0, outer, 0, Pi/2};
  Sphere(2) = {0, 0, 0, radius, 0, Pi/2};
  BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; }
EndIf
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.MeshSizeFactor = part == 1 ? 1 : 0.75;
