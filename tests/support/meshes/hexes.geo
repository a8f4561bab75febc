// Eight hexahedra in the unit cube, which the reader refuses.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Transfinite Curve{:} = 3;
Transfinite Surface{:};
Transfinite Volume{:};
Recombine Surface{:};
