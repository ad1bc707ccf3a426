// What modes and motions are called: by nodal diameters and circles of the motion along the axis, or as in the plane.

const isInPlane = ({in_plane}) => (in_plane ?? 0) > 0.5;
const counted = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

// "(3, 1)": three nodal diameters, one nodal circle; "3 in plane".
function shortName(of) {
  if (of?.diameters === null || of?.diameters === undefined) return "";
  if (isInPlane(of)) return `${of.diameters} in plane`;
  return of.circles === null || of.circles === undefined ? `(${of.diameters})` : `(${of.diameters}, ${of.circles})`;
}

function longName(of) {
  if (of?.diameters === null || of?.diameters === undefined) return "";
  const waves = counted(of.diameters, "nodal diameter");
  if (isInPlane(of)) return `in-plane, ${waves}`;
  return of.circles === null || of.circles === undefined ? waves : `${waves}, ${counted(of.circles, "circle")}`;
}

// What the brackets of short names hold, for the title of a figure that has them.
function saidOfNames(modes) {
  const named = modes.filter(mode => shortName(mode));
  if (!named.length) return "";
  return named.some(mode => /,/.test(shortName(mode))) ? "in brackets nodal diameters and nodal circles" : "in brackets nodal diameters";
}
