// Mid-surfaces of a brake disc: a ring with two rows of cooling holes, a cylindrical wall and a
// flange. Lengths in mm. Another disc: [mesh] parameters of the scene, or gmsh -setnumber NAME VALUE.
DefineConstant[
  outer_radius = 162, wall_radius = 70, hub_radius = 35, height = 46,
  track_radius = 130, n_track = 60,   // a circle with nodes at equal angles, for the pads
  n_holes = 8, hole_radius = 7, inner_holes = 105, outer_holes = 147,
  n_bolts = 0, bolt_radius = 7, bolt_circle = 52,   // holes of the flange, in the group "bolts"
  size = 16                           // of elements
];
Mesh.MeshSizeMax = size;

// cx, cy, cz, cr, cn -> arcs[] of a circle and points[] between them; n_on_arc elements on each.
Macro AddCircle
  centre = newp;
  Point(centre) = {cx, cy, cz};
  points[] = {};
  For i In {0 : cn - 1}
    p = newp;
    Point(p) = {cx + cr * Cos(2 * Pi * i / cn), cy + cr * Sin(2 * Pi * i / cn), cz};
    points[] += p;
  EndFor
  arcs[] = {};
  For i In {0 : cn - 1}
    c = newc;
    Circle(c) = {points[i], centre, points[(i + 1) % cn]};
    Transfinite Curve{c} = n_on_arc + 1;
    arcs[] += c;
  EndFor
Return

// hole_circle, hole_phase -> hole_loops[] of a row of holes
Macro AddHoles
  hole_loops[] = {};
  For j In {0 : n_holes - 1}
    phi = 2 * Pi * (j + hole_phase) / n_holes;
    cx = hole_circle * Cos(phi); cy = hole_circle * Sin(phi); cz = 0; cr = hole_radius; cn = 4;
    n_on_arc = 3;
    Call AddCircle;
    l = newll;
    Curve Loop(l) = {arcs[]};
    hole_loops[] += l;
    hole_edges[] += arcs[];
  EndFor
Return

// A Call stands on a line of its own, or Gmsh loses what follows it.
hole_edges[] = {};
hole_circle = inner_holes; hole_phase = 0.25;
Call AddHoles;
inner_loops[] = hole_loops[];
hole_circle = outer_holes; hole_phase = 0.75;
Call AddHoles;
outer_loops[] = hole_loops[];

cx = 0; cy = 0; cz = 0;
cr = outer_radius; cn = 4; n_on_arc = Ceil(Pi * cr / (2 * size));
Call AddCircle;
outer_edge[] = arcs[];
cr = track_radius; cn = n_track; n_on_arc = Ceil(2 * Pi * cr / (cn * size));
Call AddCircle;
track[] = arcs[];
cr = wall_radius; cn = 4; n_on_arc = Max(3, Ceil(Pi * cr / (2 * size)));
Call AddCircle;
seat[] = arcs[]; seat_points[] = points[];
cz = height;
Call AddCircle;
top[] = arcs[]; top_points[] = points[];
cr = hub_radius; n_on_arc = Max(3, Ceil(Pi * cr / (2 * size)));
Call AddCircle;
hub_edge[] = arcs[];

bolt_loops[] = {};
bolt_edges[] = {};
For j In {0 : n_bolts - 1}
  phi = 2 * Pi * j / n_bolts;
  cx = bolt_circle * Cos(phi); cy = bolt_circle * Sin(phi); cz = height; cr = bolt_radius; cn = 4;
  n_on_arc = 2;
  Call AddCircle;
  l = newll;
  Curve Loop(l) = {arcs[]};
  bolt_loops[] += l;
  bolt_edges[] += arcs[];
EndFor

around = newll; Curve Loop(around) = {outer_edge[]};
middle = newll; Curve Loop(middle) = {track[]};
foot = newll; Curve Loop(foot) = {seat[]};
rim = newll; Curve Loop(rim) = {top[]};
hub = newll; Curve Loop(hub) = {hub_edge[]};
Plane Surface(1) = {around, middle, outer_loops[]};
Plane Surface(2) = {middle, foot, inner_loops[]};
Plane Surface(3) = {rim, hub, bolt_loops[]};

uprights[] = {};
wall[] = {};
For i In {0 : 3}
  c = newc;
  Line(c) = {top_points[i], seat_points[i]};
  Transfinite Curve{c} = Ceil(height / size) + 1;
  uprights[] += c;
EndFor
For i In {0 : 3}
  l = newll;
  Curve Loop(l) = {uprights[i], seat[i], -uprights[(i + 1) % 4], -top[i]};
  s = news;
  Surface(s) = {l};
  Transfinite Surface{s};
  wall[] += s;
EndFor

Physical Surface("disc") = {1, 2};
Physical Surface("wall") = {wall[]};
Physical Surface("flange") = {3};
Physical Curve("outer_edge") = {outer_edge[]};
Physical Curve("hub_edge") = {hub_edge[]};
Physical Curve("holes") = {hole_edges[]};
If (n_bolts > 0)
  Physical Curve("bolts") = {bolt_edges[]};
EndIf
