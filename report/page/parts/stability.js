// Stability of sliding: diagrams over a parameter, and the table of unstable modes.

const speedAxis = {label: "rotation speed, rad/s"};

// Growth within a few times that of the motions that matter: what decays fast would hide it. All of
// what was measured is seen.
function growthAxis(rows, measured = []) {
  const values = [...rows.flat(), ...measured].filter(Number.isFinite).sort((a, b) => a - b);
  const [lowest, largest] = [values[0], values.at(-1)], median = values[values.length >> 1];
  const least = largest > 1e-6 ? -1.5 * largest : 4 * median, high = largest > 1e-6 ? 1.2 * largest : -0.1 * median;
  const low = Math.min(least, ...measured.map(rate => 1.1 * rate));
  const axis = {label: "growth rate, 1/s"};
  return lowest < low && low < high ? {...axis, low, high} : axis;
}

// The number of each curve by rising frequency.
function numbers(rows) {
  const order = rows.map((row, j) => [row[0], j]).sort((a, b) => a[0] - b[0]);
  const number = [];
  order.forEach(([, j], k) => { number[j] = k + 1; });
  return number;
}

function campbellFigures({campbell, critical}) {
  const number = numbers(campbell.frequency_Hz), measured = content().growth ?? [];
  const first = campbell.growth.map(row => row.some(growth => growth > 1e-6));
  const labelled = j => ({label: String(number[j]), first: first[j]});
  const curves = campbell.frequency_Hz.map((f, j) =>
    ({x: campbell.speeds, y: f, colour: 0, ...labelled(j), name: j ? "" : "eigenfrequency"}));
  const unstable = {x: [], y: [], line: false, marker: "circle", colour: 1, name: "grows"};
  campbell.growth.forEach((row, j) => row.forEach((growth, i) => {
    if (!(growth > 1e-6)) return;
    unstable.x.push(campbell.speeds[i]);
    unstable.y.push(campbell.frequency_Hz[j][i]);
  }));
  const marks = unstable.x.length ? [unstable] : [];
  const star = key => critical ? [{x: [critical.speed], y: [key ? critical.frequency_Hz : 0], line: false, marker: "star",
                                   colour: 3, name: "onset of squeal"}] : [];
  const rates = campbell.growth.map((row, j) =>
    ({x: campbell.speeds, y: row, colour: 0, ...labelled(j), name: j ? "" : "growth rate"}));
  const zero = {x: [campbell.speeds[0], campbell.speeds.at(-1)], y: [0, 0], colour: 5, dash: "5 4", width: 1.2};
  return [plot({title: "Campbell diagram: frequencies in the frame of the pads over the speed",
                x: speedAxis, y: {label: "frequency, Hz"}, series: [...curves, ...marks, ...star(true)]}),
          plot({title: "Growth rates: above zero the brake squeals", x: speedAxis, y: growthAxis(campbell.growth, measured.map(g => g.rate)),
                series: [zero, ...rates, ...growthMarks(), ...star(false)]})];
  function growthMarks() {
    return measured.length ? [{x: measured.map(g => g.speed), y: measured.map(g => g.rate), line: false, marker: "square",
                             colour: 2, name: "measured in transients"}] : [];
  }
}

function rotationFigures({rotation: {speeds, growth, frozen, exponents}}) {
  const others = exponents.slice(1).map((y, j) => ({x: speeds, y, colour: 0, width: 0.8, name: j ? "" : "next exponents"}));
  const standing = frozen.length ? [{x: speeds, y: frozen, colour: 1, dash: "5 4", name: "standing at its worst angle"}] : [];
  const series = [...others, {x: speeds, y: growth, colour: 2, name: "turning disc"}, ...standing];
  return [plot({title: "Growth rates of the disc as it is", x: speedAxis, y: growthAxis([growth, frozen, ...exponents]), series})];
}

// Per cent of its energy that a motion takes from something in a period.
const inPeriod = x => x === null ? "" : `${formatted(100 * x, 3)} %`;

const share = x => x === null ? "" : `${formatted(100 * x, 2)} %`;

function unstableModesTable({unstable_modes: {branches, parameter, unit}}) {
  const rows = branches.map((branch, j) => [j + 1, branch]).filter(([, {unstable}]) => unstable.length);
  if (!rows.length) return note("");
  const known = rows.some(([, {diameters}]) => diameters !== null);
  const circled = rows.some(([, {circles}]) => circles !== null), flat = rows.some(([, {in_plane}]) => in_plane !== null);
  const header = ["mode", "frequency, Hz", ...(known ? ["nodal diameters"] : []), ...(circled ? ["nodal circles"] : []),
                  ...(flat ? ["in plane"] : []),
                  `unstable from, to (${parameter}${unit !== "1" ? `, ${unit}` : ""})`, "growth, 1/s", "damping ratio",
                  ...(known ? ["gain from friction in a period"] : [])];
  return scrolled(table(header, rows.map(([number, branch]) => [
    String(number), formatted(branch.worst_Hz, 6), ...(known ? [String(branch.diameters)] : []),
    ...(circled ? [branch.circles === null ? "" : String(branch.circles)] : []), ...(flat ? [share(branch.in_plane)] : []),
    branch.unstable.map(([from, to]) => `${formatted(from)} to ${formatted(to)}`).join(", "),
    formatted(branch.worst_growth), formatted(branch.damping_ratio, 3), ...(known ? [inPeriod(branch.friction_work)] : [])])));
}

// All modes over a parameter, labelled by their numbers and, in brackets, their nodal diameters.
function unstableModesFigures({unstable_modes: table}) {
  const named = table.parameter === "speed" ? speedAxis.label
    : `${table.parameter}${table.unit !== "1" ? `, ${table.unit}` : ""}`;
  const x = {label: named}, values = table.values, legend = new Map();
  const curves = [], rates = [], grow = [];
  for (const [j, {frequency_Hz, growth, unstable, diameters}] of table.branches.entries()) {
    const colour = unstable.length ? 1 + (diameters ?? 0) % 4 : 0, width = unstable.length ? 1.8 : 0.8;
    const label = !unstable.length ? "stable modes" : diameters === null ? "unstable modes" : `${diameters} nodal diameters`;
    const name = legend.has(label) ? "" : label;
    legend.set(label, true);
    const text = diameters === null ? String(j + 1) : `${j + 1} (${diameters})`;
    const more = {colour, width, name, label: text, first: unstable.length > 0};
    curves.push({x: values, y: frequency_Hz, ...more});
    rates.push({x: values, y: growth, ...more});
    const inside = values.map(v => unstable.some(([from, to]) => from <= v && v <= to));
    if (inside.some(Boolean))
      grow.push({x: values.filter((_, i) => inside[i]), y: frequency_Hz.filter((_, i) => inside[i]), colour,
                 line: false, marker: "circle", name: grow.length ? "" : "grows"});
  }
  const zero = {x: [values[0], values.at(-1)], y: [0, 0], colour: 5, dash: "5 4", width: 1.2};
  const named_by = table.branches.some(({diameters}) => diameters !== null)
    ? "number of each mode and, in brackets, its nodal diameters" : "number of each mode";
  return [plot({title: `Campbell diagram: ${table.summary}; ${named_by}`, x, y: {label: "frequency, Hz"}, series: [...curves, ...grow]}),
          plot({title: "Growth of each mode", x, y: growthAxis(table.branches.map(({growth}) => growth)), series: [zero, ...rates]})];
}
