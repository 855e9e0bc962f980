// Rectangular bar, 0.4 x 0.4 x 1.2, unit: micrometre (length_unit_nm = 1000). Distorted on purpose: the cells are not cubes.
// gmsh -3 bar.geo -format msh41 -o bar.msh
width = 0.4;
length = 1.2;
n_width = 4;
n_length = 8;
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, width, 0};
Point(4) = {0, width, 0};
For i In {1 : 4}
  Line(i) = {i, i % 4 + 1};
EndFor
Transfinite Curve {1, 2, 3, 4} = n_width + 1 Using Bump 0.5;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
bar[] = Extrude {0, 0, length} { Surface{1}; Layers{n_length}; Recombine; };
Physical Surface("bottom", 1) = {1};
Physical Surface("top", 2) = {bar[0]};
Physical Surface("side", 3) = {bar[2], bar[3], bar[4], bar[5]};
Physical Volume("grain", 1) = {bar[1]};
