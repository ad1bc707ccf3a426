// Two friction rings joined by radial vanes; lengths in m.
DefineConstant[
  inner_radius = 0.09, outer_radius = 0.162, track_radius = 0.13,
  half_gap = 0.012, n_vanes = 24, size = 0.02
];
Mesh.MeshSizeMax = size;

// cr, cz -> points[] and arcs[] of a circle with a point at each vane.
Macro AddCircle
  centre = newp; Point(centre) = {0, 0, cz};
  points[] = {}; arcs[] = {};
  For i In {0 : n_vanes - 1}
    p = newp; Point(p) = {cr * Cos(2 * Pi * i / n_vanes), cr * Sin(2 * Pi * i / n_vanes), cz};
    points[] += p;
  EndFor
  For i In {0 : n_vanes - 1}
    c = newc; Circle(c) = {points[i], centre, points[(i + 1) % n_vanes]};
    Transfinite Curve{c} = 2;
    arcs[] += c;
  EndFor
Return

rings[] = {}; feet[] = {};
For side In {0 : 1}
  cz = (2 * side - 1) * half_gap;
  cr = inner_radius;
  Call AddCircle;
  p0[] = points[]; a0[] = arcs[];
  cr = track_radius;
  Call AddCircle;
  p1[] = points[]; a1[] = arcs[];
  cr = outer_radius;
  Call AddCircle;
  p2[] = points[]; a2[] = arcs[];
  r0[] = {}; r1[] = {};
  For i In {0 : n_vanes - 1}
    c = newc; Line(c) = {p0[i], p1[i]}; Transfinite Curve{c} = Ceil((track_radius - inner_radius) / size) + 1; r0[] += c;
    c = newc; Line(c) = {p1[i], p2[i]}; Transfinite Curve{c} = Ceil((outer_radius - track_radius) / size) + 1; r1[] += c;
  EndFor
  For i In {0 : n_vanes - 1}
    j = (i + 1) % n_vanes;
    l = newll; Curve Loop(l) = {r0[i], a1[i], -r0[j], -a0[i]}; s = news; Surface(s) = {l}; Transfinite Surface{s}; rings[] += s;
    l = newll; Curve Loop(l) = {r1[i], a2[i], -r1[j], -a1[i]}; s = news; Surface(s) = {l}; Transfinite Surface{s}; rings[] += s;
  EndFor
  If (side == 0)
    q0[] = p0[]; q1[] = p1[]; q2[] = p2[]; s0[] = r0[]; s1[] = r1[];
    hub_edge[] = a0[];
  EndIf
EndFor
vanes[] = {};
up0[] = {}; up1[] = {}; up2[] = {};
For i In {0 : n_vanes - 1}
  c = newc; Line(c) = {q0[i], p0[i]}; Transfinite Curve{c} = 4; up0[] += c;
  c = newc; Line(c) = {q1[i], p1[i]}; Transfinite Curve{c} = 4; up1[] += c;
  c = newc; Line(c) = {q2[i], p2[i]}; Transfinite Curve{c} = 4; up2[] += c;
  l = newll; Curve Loop(l) = {s0[i], up1[i], -r0[i], -up0[i]}; s = news; Surface(s) = {l}; Transfinite Surface{s}; vanes[] += s;
  l = newll; Curve Loop(l) = {s1[i], up2[i], -r1[i], -up1[i]}; s = news; Surface(s) = {l}; Transfinite Surface{s}; vanes[] += s;
EndFor
Physical Surface("rings") = {rings[]};
Physical Surface("vanes") = {vanes[]};
Physical Curve("hub_edge") = {hub_edge[]};
