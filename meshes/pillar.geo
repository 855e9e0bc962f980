// Cylindrical pillar, diameter 1, height 2, unit: micrometre (length_unit_nm = 1000). Square core and four outer blocks; the
// edges of the cells on the side are straight.
// gmsh -3 pillar.geo -format msh22 -o pillar.msh
radius = 0.5;
height = 2;
core = 0.28;
n_core = 4;
n_ring = 2;
n_height = 10;
Point(1) = {0, 0, 0};
For i In {1 : 4}
  angle = (2 * i - 1) * Pi / 4;
  Point(1 + i) = {core * Cos(angle), core * Sin(angle), 0};
  Point(5 + i) = {radius * Cos(angle), radius * Sin(angle), 0};
EndFor
For i In {1 : 4}
  Line(i) = {1 + i, 2 + i % 4};
  Circle(4 + i) = {5 + i, 1, 6 + i % 4};
  Line(8 + i) = {1 + i, 5 + i};
EndFor
Transfinite Curve {1 : 8} = n_core + 1;
Transfinite Curve {9 : 12} = n_ring + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
For i In {1 : 4}
  Curve Loop(1 + i) = {8 + i, 4 + i, -(9 + i % 4), -i};
  Plane Surface(1 + i) = {1 + i};
EndFor
Transfinite Surface {1 : 5};
Recombine Surface {1 : 5};
Physical Surface("bottom", 1) = {1 : 5};
For i In {1 : 5}
  block[] = Extrude {0, 0, height} { Surface{i}; Layers{n_height}; Recombine; };
  top[i - 1] = block[0];
  volume[i - 1] = block[1];
  If(i > 1)
    side[i - 2] = block[3];
  EndIf
EndFor
Physical Surface("top", 2) = {top[]};
Physical Surface("side", 3) = {side[]};
Physical Volume("grain", 1) = {volume[]};
