// A box with a cylindrical shaft cut out: gmsh -3 -setnumber h 0.2 -o shaft.msh shaft.geo
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.2 ];
Box(1) = {0, -0.75, -0.75, 2, 1.5, 1.5};
Cylinder(2) = {-0.1, 0, 0, 2.2, 0, 0, 0.3};
v[] = BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; };
skin[] = Boundary{ Volume{v[]}; };
Physical Volume("fluid", 1) = {v[]};
Physical Surface("skin", 11) = {skin[]};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
