// One of five equal sectors of a ventilated disc of 320 mm: two friction rings, radial vanes between them, wall and flange of the hat.
// Mid-surfaces in mm, all of structured quadrilaterals. The lines of a meridian are extruded by 6 degrees, `steps` times: 12 steps are a
// sector, 60 the whole disc.
SetFactory("Built-in");
DefineConstant[ steps = 12, refine = 1 ];                        // refine: elements for each step and each part of a line
h = 9.5;                                                         // half the distance of the two rings
top = h + 40;
step = Pi / 30;
ring() = {95, 100, 130, 155, 160}; in_ring() = {1, 2, 2, 1};     // radii, and elements between them; the pads touch r = 130
flat() = {35, 50, 64, 95};         in_flat() = {1, 1, 2};

// the meridian
low() = {}; points() = {};
For i In {0 : #ring() - 1}
  p = newp; Point(p) = {ring(i), 0, -h}; points() += p;
EndFor
For i In {0 : #in_ring() - 1}
  l = newl; Line(l) = {points(i), points(i + 1)}; Transfinite Curve{l} = in_ring(i) * refine + 1; low() += l;
EndFor
up() = {}; points() = {};
For i In {0 : #ring() - 1}
  p = newp; Point(p) = {ring(i), 0, h}; points() += p;
EndFor
For i In {0 : #in_ring() - 1}
  l = newl; Line(l) = {points(i), points(i + 1)}; Transfinite Curve{l} = in_ring(i) * refine + 1; up() += l;
EndFor
foot = points(0);
hat() = {}; points() = {};
For i In {0 : #flat() - 1}
  p = newp; Point(p) = {flat(i), 0, top}; points() += p;
EndFor
For i In {0 : #in_flat() - 1}
  l = newl; Line(l) = {points(i), points(i + 1)}; Transfinite Curve{l} = in_flat(i) * refine + 1; hat() += l;
EndFor
wall = newl; Line(wall) = {foot, points(#points() - 1)}; Transfinite Curve{wall} = 3 * refine + 1;

// the turn: each line leaves a surface, and its turned copy takes its place
inboard() = {}; outboard() = {}; walls() = {}; flange() = {}; bolt() = {}; vanes() = {};
For s In {0 : steps - 1}
  o() = Extrude {{0, 0, 1}, {0, 0, 0}, step} { Curve{low()}; Layers{refine}; Recombine; };
  low() = {};
  For i In {0 : #in_ring() - 1}
    low() += o(4 * i); inboard() += o(4 * i + 1);
  EndFor
  o() = Extrude {{0, 0, 1}, {0, 0, 0}, step} { Curve{up()}; Layers{refine}; Recombine; };
  up() = {};
  For i In {0 : #in_ring() - 1}
    up() += o(4 * i); outboard() += o(4 * i + 1);
  EndFor
  o() = Extrude {{0, 0, 1}, {0, 0, 0}, step} { Curve{hat()}; Layers{refine}; Recombine; };
  hat() = {};
  For i In {0 : #in_flat() - 1}
    hat() += o(4 * i);
    If (i == 1 && (s % 12 == 5 || s % 12 == 6))                  // the patch of one bolt, in the middle of the sector
      bolt() += o(4 * i + 1);
    Else
      flange() += o(4 * i + 1);
    EndIf
  EndFor
  o() = Extrude {{0, 0, 1}, {0, 0, 0}, step} { Curve{wall}; Layers{refine}; Recombine; };
  wall = o(0); walls() += o(1);
  If (s % 2 == 0)                                                // a vane from r = 100 to 155, every 12 degrees
    a() = Boundary{ Curve{low(1)}; }; b() = Boundary{ Curve{low(2)}; };
    c() = Boundary{ Curve{up(1)}; };  d() = Boundary{ Curve{up(2)}; };
    v0 = newl; Line(v0) = {a(0), c(0)}; v1 = newl; Line(v1) = {a(1), c(1)}; v2 = newl; Line(v2) = {b(1), d(1)};
    Transfinite Curve{v0, v1, v2} = 2 * refine + 1;
    k = newll; Curve Loop(k) = {low(1), v1, -up(1), -v0}; q = news; Surface(q) = {k}; Transfinite Surface{q}; Recombine Surface{q}; vanes() += q;
    k = newll; Curve Loop(k) = {low(2), v2, -up(2), -v1}; q = news; Surface(q) = {k}; Transfinite Surface{q}; Recombine Surface{q}; vanes() += q;
  EndIf
EndFor
Coherence;
Physical Surface("inboard") = {inboard()};
Physical Surface("outboard") = {outboard()};
Physical Surface("vanes") = {vanes()};
Physical Surface("wall") = {walls()};
Physical Surface("flange") = {flange()};
Physical Surface("bolt") = {bolt()};
bore() = Curve In BoundingBox{-36, -36, top - 1, 36, 36, top + 1};
Physical Curve("bore") = {bore()};                                // named, so that the many other curves are no groups
