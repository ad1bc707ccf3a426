// Stability of sliding: diagrams over a parameter, and the table of unstable modes.

const speedAxis = {label: "rotation speed, rad/s", second: {factor: rpmOfRadS, unit: "rpm"}};

// Growth rates on a scale that shows all of them and where they cross zero; the other choice is a linear axis within a
// few times the growth of the motions that matter. All of what was measured is seen on both.
function growthAxes(rows, measured = []) {
  const values = [...rows.flat(), ...measured].filter(Number.isFinite).sort((a, b) => a - b);
  const [lowest, largest] = [values[0], values.at(-1)], median = values[values.length >> 1], label = "growth rate, 1/s";
  const least = largest > 1e-6 ? -1.5 * largest : 4 * median, high = largest > 1e-6 ? 1.2 * largest : -0.1 * median;
  const low = Math.min(least, ...measured.map(rate => 1.1 * rate));
  const near = lowest < low && low < high ? {label, low, high} : {label};
  const all = signedAxis(label, [...rows, measured]);
  return {choices: {"signed logarithm": all, "linear near zero": near}};
}

// Where curves go through zero, between the values that were looked at.
function crossings(values, rows) {
  const found = {x: [], y: [], line: false, marker: "circle", hollow: true, colour: 3, name: "crosses zero"};
  for (const row of rows) for (let i = 0; i + 1 < row.length && found.x.length < 60; ++i) {
    if (!(row[i] * row[i + 1] < 0)) continue;
    found.x.push(values[i] + (values[i + 1] - values[i]) * row[i] / (row[i] - row[i + 1]));
    found.y.push(0);
  }
  return found.x.length ? [found] : [];
}

// The number of each curve by rising frequency.
function numbers(rows) {
  const order = rows.map((row, j) => [row[0], j]).sort((a, b) => a[0] - b[0]);
  const number = [];
  order.forEach(([, j], k) => { number[j] = k + 1; });
  return number;
}

// Each motion has the label of the mode that it is like, or a number.
function campbellNames({frequency_Hz, looks}) {
  const number = numbers(frequency_Hz);
  return frequency_Hz.map((row, j) => ({label: shortName(looks?.[j]) || String(number[j]),
                                        said: [`motion ${number[j]}`, longName(looks?.[j])].filter(Boolean).join(", ")}));
}

function campbellFigures({campbell, critical, growth: measured = []}) {
  const {speeds, frequency_Hz, growth} = campbell, names = campbellNames(campbell);
  const styled_as = (j, name) => ({...names[j], first: growth[j].some(rate => rate > 1e-6), name: j ? "" : name, colour: 0, width: 1.4});
  const curves = frequency_Hz.map((y, j) => ({x: speeds, y, ...styled_as(j, "eigenfrequency")}));
  const unstable = growth.flatMap((row, j) => {
    const at = row.map((rate, i) => i).filter(i => row[i] > 1e-6);
    return at.length ? [{x: at.map(i => speeds[i]), y: at.map(i => frequency_Hz[j][i]), line: false, marker: "circle", colour: 1,
                         said: `${names[j].said}, grows`}] : [];
  });
  if (unstable.length) unstable[0].name = "grows";
  const star = y => critical ? [{x: [critical.speed], y: [y], line: false, marker: "star", colour: 3, name: "onset of squeal"}] : [];
  const rates = growth.map((y, j) => ({x: speeds, y, ...styled_as(j, "growth rate")}));
  const marks = measured.length ? [{x: measured.map(g => g.speed), y: measured.map(g => g.rate), line: false, marker: "square",
                                    colour: 2, name: "measured in transients"}] : [];
  const brackets = saidOfNames(campbell.looks ?? []), note_of = brackets ? `; ${brackets}` : "";
  return [plot({title: `Campbell diagram: frequencies in the frame of the pads over the speed${note_of}`, height: 320,
                x: speedAxis, y: {label: "frequency, Hz"}, series: [...curves, ...unstable, ...star(critical?.frequency_Hz)]}),
          plot({title: `Growth rates: above zero the brake squeals${note_of}`, height: 320, x: speedAxis,
                ...growthAxes(growth, measured.map(g => g.rate)), series: [...rates, ...crossings(speeds, growth), ...marks, ...star(0)]})];
}

function rotationFigures({rotation: {speeds, growth, frozen, exponents}}) {
  const others = exponents.slice(1).map((y, j) => ({x: speeds, y, colour: 0, width: 0.8, name: j ? "" : "next exponents"}));
  const standing = frozen.length ? [{x: speeds, y: frozen, colour: 1, dash: "5 4", name: "standing at its worst angle"}] : [];
  const series = [...others, {x: speeds, y: growth, colour: 2, name: "turning disc"}, ...standing];
  return [plot({title: "Growth rates of the disc as it is", x: speedAxis, ...growthAxes([growth, frozen, ...exponents]),
                series: [...series, ...crossings(speeds, [growth])]})];
}

// Per cent of its energy that a motion takes from something in a period.
const inPeriod = x => x === null ? "" : `${formatted(100 * x, 3)} %`;

const share = x => x === null ? "" : `${formatted(100 * x, 2)} %`;

// "13.4 to 20.1"; speeds are in rpm too.
function rangeText([from, to], isSpeed) {
  return `${formatted(from)} to ${formatted(to)}${isSpeed ? ` (${formatted(from * rpmOfRadS)} to ${rpm(to)})` : ""}`;
}

function unstableModesTable({unstable_modes: {branches, parameter, unit}}) {
  const rows = branches.map((branch, j) => [j + 1, branch]).filter(([, {unstable}]) => unstable.length);
  if (!rows.length) return note("");
  const known = rows.some(([, {diameters}]) => diameters !== null), flat = rows.some(([, {in_plane}]) => in_plane !== null);
  const named = parameter === "speed" ? "rotation speed, rad/s (rpm)" : `${parameter}${unit !== "1" ? `, ${unit}` : ""}`;
  const header = ["mode", "frequency, Hz", ...(known ? ["shape"] : []), ...(flat ? ["motion in the plane"] : []),
                  `unstable from, to: ${named}`, "growth, 1/s", "damping ratio", ...(known ? ["gain from friction in a period"] : [])];
  return scrolled(table(header, rows.map(([number, branch]) => [
    String(number), formatted(branch.worst_Hz, 6), ...(known ? [longName(branch)] : []), ...(flat ? [share(branch.in_plane)] : []),
    branch.unstable.map(range => rangeText(range, parameter === "speed")).join("; "),
    withError(branch.worst_growth, branch.growth_error), formatted(branch.damping_ratio, 3), ...(known ? [inPeriod(branch.friction_work)] : [])])));
}

// All modes over a parameter, each labelled by what it is like.
function unstableModesFigures({unstable_modes: table}) {
  const isSpeed = table.parameter === "speed", {values, branches} = table, legend = new Set();
  const x = isSpeed ? speedAxis : {label: `${table.parameter}${table.unit !== "1" ? `, ${table.unit}` : ""}`};
  const curves = [], rates = [], grow = [];
  for (const [j, branch] of branches.entries()) {
    const {frequency_Hz, growth, unstable, diameters} = branch, grows = unstable.length > 0;
    const kind = !grows ? "stable modes" : diameters === null ? "unstable modes" : counted(diameters, "nodal diameter");
    const more = {colour: grows ? 1 + (diameters ?? 0) % 4 : 0, width: grows ? 1.8 : 0.8, name: legend.has(kind) ? "" : kind,
                  first: grows, label: grows ? `${j + 1} ${shortName(branch)}`.trim() : shortName(branch) || String(j + 1),
                  said: [`mode ${j + 1}`, longName(branch)].filter(Boolean).join(", ")};
    legend.add(kind);
    curves.push({x: values, y: frequency_Hz, ...more});
    rates.push({x: values, y: growth, ...more});
    const inside = values.map(v => unstable.some(([from, to]) => from <= v && v <= to));
    if (inside.some(Boolean))
      grow.push({x: values.filter((_, i) => inside[i]), y: frequency_Hz.filter((_, i) => inside[i]), colour: more.colour,
                 line: false, marker: "circle", name: grow.length ? "" : "grows", said: `${more.said}, grows`});
  }
  const limits = branches.flatMap(({unstable}) => unstable.flat()).filter(v => v > values[0] && v < values.at(-1));
  const ends = {x: limits, y: limits.map(() => 0), line: false, marker: "circle", hollow: true, colour: 3, name: "limit of stability"};
  const brackets = saidOfNames(branches), named = brackets ? `labels: number of an unstable mode, ${brackets}` : "labels: number of each mode";
  return [plot({title: `Campbell diagram: ${table.summary}; ${named}`, height: 320, x, y: {label: "frequency, Hz"}, series: [...curves, ...grow]}),
          plot({title: `Growth of each mode; ${named}`, height: 320, x, ...growthAxes(branches.map(({growth}) => growth)),
                series: [...rates, ...(limits.length ? [ends] : [])]})];
}
