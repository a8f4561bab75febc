// A cube with a constant vector at its nodes, saved as a mesh with data.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 0.5;
Mesh 3;
Plugin(NewView).NumComp = 3;
Plugin(NewView).Value = 1.5;
Plugin(NewView).Run;
View[0].Name = "a constant";
Save View[0] Str(file);
