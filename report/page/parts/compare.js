// Several runs beside each other: their figures in a table, their curves in one picture.

// The largest growth rate at each speed; nothing without eigenvalues over the speed.
function worstGrowth({campbell, unstable_modes: table}) {
  const [x, rows] = campbell ? [campbell.speeds, campbell.growth]
    : table?.parameter === "speed" ? [table.values, table.branches.map(branch => branch.growth)] : [[], []];
  if (!rows.length) return null;
  return {x, y: x.map((speed, i) => rows.reduce((most, row) => row[i] > most ? row[i] : most, -Infinity))};
}

function growingPoints({campbell}) {
  if (!campbell) return null;
  const at = campbell.growth.flatMap((row, j) => row.map((rate, i) => [rate, i, j])).filter(([rate]) => rate > 1e-6);
  return {x: at.map(([, i]) => campbell.speeds[i]), y: at.map(([, i, j]) => campbell.frequency_Hz[j][i])};
}

const loudest = ({sound}) => sound?.microphones?.length ? Math.max(...sound.microphones.map(({level_A_dB}) => level_A_dB)) : undefined;

// What a run came to is no limit cycle before it has settled.
const settledText = cycle => cycle.doubt === "not settled" ? cycle.doubt : `limit cycle${cycle.doubt && `, ${cycle.doubt}`}`;
const areCycles = runs => runs.map(chosenCycle).every(cycle => cycle?.doubt !== "not settled");
const settledName = more => runs => `${areCycles(runs) ? "limit cycle" : "vibration"}${more}`;

// [what, or its name for these runs; value of a run]: numbers are subtracted, texts are not.
const compared = [
  ["modes of the body", run => run.modes?.length],
  ["squeals from, rad/s", run => run.critical?.speed],
  ["squeals from, rpm", run => run.critical && run.critical.speed * rpmOfRadS],
  ["frequency there, Hz", run => run.critical?.frequency_Hz],
  ["stability over the speed", run => run.stability],
  ["largest growth rate in the range, 1/s", run => worstGrowth(run) && Math.max(...worstGrowth(run).y)],
  ["unstable modes", run => run.unstable_modes?.branches.filter(branch => branch.unstable.length).length],
  ["vibration", run => chosenCycle(run) && settledText(chosenCycle(run))],
  [settledName(" at, rad/s"), run => chosenCycle(run)?.speed],
  [settledName(", Hz"), run => chosenCycle(run)?.frequency_Hz],
  ["pad velocity, m/s", run => chosenCycle(run)?.pad_velocity],
  ["pad displacement, mm", run => chosenCycle(run) && 1e3 * chosenCycle(run).pad_displacement],
  ["least normal force, N", run => chosenCycle(run)?.N_min],
  ["largest normal force, N", run => chosenCycle(run)?.N_max],
  ["effective pad velocity over the last rotations, m/s", run => run.statistics?.rms_velocity],
  ["loudest microphone, dB(A)", loudest],
  ["radiated power, W", run => run.sound?.tones?.length ? run.sound.tones.reduce((sum, tone) => sum + tone.power, 0) : undefined]];

// How a number differs from that of the first run; levels differ by decibels.
function difference(what, first, value) {
  if (typeof first !== "number" || typeof value !== "number" || first === value) return "";
  const change = value - first, sign = change > 0 ? "+" : "";
  if (/dB/.test(what) || first === 0) return ` (${sign}${formatted(change, 3)})`;
  return ` (${sign}${formatted(100 * change / Math.abs(first), 3)}${unbroken}%)`;
}

function comparisonTable(runs) {
  const text = value => value === null || value === undefined ? "–" : typeof value === "number" ? formatted(value, 5) : value;
  const known = compared.map(([what, of]) => [typeof what === "string" ? what : what(runs), runs.map(of)]).filter(([, values]) => values.some(v => v !== null && v !== undefined));
  const rows = known.map(([what, values]) => [what, ...values.map((v, k) => text(v) + (k ? difference(what, values[0], v) : ""))]);
  return scrolled(table(["", ...runs.map(run => run.label)], rows), "whole");
}

// Modes of one name stand beside each other, the lowest first, as often as each body has them.
function modesBeside(runs) {
  const of = runs.map(run => {
    const seen = new Map();
    return new Map((run.modes ?? []).filter(mode => longName(mode)).map(mode => {
      const name = longName(mode), k = (seen.get(name) ?? 0) + 1;
      seen.set(name, k);
      return [`${name}${k > 1 ? `, no. ${k}` : ""}`, mode.frequency_Hz];
    }));
  });
  if (of.some(names => !names.size)) return "";
  const isSame = one => one.size === of[0].size && [...one].every(([name, f_Hz]) => of[0].get(name) === f_Hz);
  if (of.every(isSame)) return note("The bodies of all runs have the same natural frequencies.");
  const names = [...of[0].keys()].filter(name => of.some((other, k) => k && other.has(name)));
  const cell = (name, k) => formatted(of[k].get(name), 6) + (k ? difference(name, of[0].get(name), of[k].get(name)) : "");
  const rows = names.map(name => [name, ...of.map((one, k) => cell(name, k))]);
  return element("div", {}, element("h3", {}, "Frequencies of modes of the same shape, Hz"),
                 scrolled(table(["shape", ...runs.map(run => run.label)], rows)));
}

// One curve of each run that has it.
function overlaid(runs, of, {marked, line} = {}) {
  const dashes = ["none", "6 3", "2 3", "9 3 2 3"];
  return runs.map((run, k) => [run, k, of(run)]).filter(([, , curve]) => curve && curve.x.length).map(([run, k, curve]) => ({
    ...curve, name: run.label, colour: k % 6, dash: dashes[k % 4], ...(marked ? {...markedAs(k), hollow: k > 0, line} : {})}));
}

const branchCurve = ({branch}) => branch && {x: withGap(branch.speed, branch.second_part), y: withGap(branch.pad_velocity, branch.second_part)};
const envelopeCurve = ({transient}) => transient && {x: transient.t, y: transient.envelope};
const spectrumCurve = ({spectrum}) => spectrum && {x: spectrum.frequency_Hz, y: spectrum.amplitude};
const loudnessCurve = ({sound}) => sound?.loudness && sound.loudness.without.levels.length &&
  {x: sound.loudness.without.speeds, y: sound.loudness.without.levels.map(row => Math.max(...row))};

function overlays(runs) {
  const growth = overlaid(runs, worstGrowth), made = [];
  if (growth.length) {
    const rows = growth.map(curve => curve.y);
    made.push(plot({title: "Growth rate of the least stable motion", x: speedAxis, ...growthAxes(rows), series: growth}));
  }
  const add = (title, x, y, series) => { if (series.length) made.push(plot({title, x, y, series})); };
  add("Frequencies that grow", speedAxis, {label: "frequency, Hz"}, overlaid(runs, growingPoints, {marked: true, line: false}));
  add("Limit cycles over the speed", speedAxis, {label: "pad velocity, m/s"}, overlaid(runs, branchCurve, {marked: true}));
  add("Envelopes of the pad velocity", {label: "time, s"}, {label: "pad velocity, m/s", log: true}, overlaid(runs, envelopeCurve));
  add("Spectra of the pad velocity", {label: "frequency, Hz"}, {label: "amplitude, m/s", log: true}, overlaid(runs, spectrumCurve));
  add("Level at the loudest microphone over the speed", speedAxis, {label: "sound pressure level, dB"}, overlaid(runs, loudnessCurve, {marked: true}));
  return made;
}

// Maps of the runs with the same axes and colours.
function mapsBeside(runs) {
  const of = runs.filter(run => run.map), largest = Math.max(...of.flatMap(run => run.map.growth.flat().map(Math.abs)));
  return of.length < 2 ? [] : of.flatMap(run => mapFigures(run, {largest, label: run.label}));
}

function drawComparison(runs) {
  const [bodies, start, ...controls] = bodiesBeside(runs);
  section("comparison", "Comparison", note("In brackets: the difference from the first run."), comparisonTable(runs),
          figures(...overlays(runs), ...mapsBeside(runs)), modesBeside(runs),
          ...(bodies ? [element("h3", {}, "Bodies in motion"), ...controls, bodies] : []));
  start?.();
}
