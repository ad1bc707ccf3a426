// The middle surface of a back plate: a sector of a ring about the x axis, in m. Each point of the grid is a point of the
// lining, and lies on a ring of the disc.
n_r = 2;
n_t = 4;
inner = 0.11;
outer = 0.15;
half = 30 * Pi / 180;
For j In {0 : n_t}
  For i In {0 : n_r}
    r = inner + (outer - inner) * i / n_r;
    angle = half * (2 * j / n_t - 1);
    Point(1 + i + (n_r + 1) * j) = {r * Cos(angle), r * Sin(angle), 0, 1};
  EndFor
EndFor
centre = newp;
Point(centre) = {0, 0, 0, 1};
For j In {0 : n_t - 1}
  For i In {0 : n_r}
    p = 1 + i + (n_r + 1) * j;
    Circle(1000 + p) = {p, centre, p + n_r + 1};
  EndFor
EndFor
For j In {0 : n_t}
  For i In {0 : n_r - 1}
    p = 1 + i + (n_r + 1) * j;
    Line(2000 + p) = {p, p + 1};
  EndFor
EndFor
For j In {0 : n_t - 1}
  For i In {0 : n_r - 1}
    p = 1 + i + (n_r + 1) * j;
    Curve Loop(p) = {2000 + p, 1000 + p + 1, -(2000 + p + n_r + 1), -(1000 + p)};
    Plane Surface(p) = {p};
    patches[] += {p};
  EndFor
EndFor
Transfinite Curve "*" = 2;
Transfinite Surface "*";
Recombine Surface "*";
Physical Surface("plate") = {patches[]};
Physical Point("lining") = {1 : (n_r + 1) * (n_t + 1)};
Physical Point("ears") = {2, 2 + (n_r + 1) * n_t};
Physical Point("back") = {2 + (n_r + 1) * n_t / 2};
