// The sections of the page; each is drawn where there is something to say.

function section(id, title, ...children) {
  const made = element("section", {id}, element("h2", {}, title), ...children);
  document.getElementById("sections").append(made);
  document.getElementById("contents").append(element("a", {href: `#${id}`}, title));
  return made;
}

const note = text => element("p", {class: "note"}, text);
const figures = (...made) => element("div", {class: "figures"}, ...made.filter(Boolean));

function table(header, rows) {
  const row = (cells, kind) => element("tr", {}, ...cells.map(cell => element(kind, {}, cell)));
  const made = element("table", {}, element("thead", {}, row(header, "th")),
                       element("tbody", {}, ...rows.map(cells => row(cells, "td"))));
  return made;
}

const scrolled = made => element("div", {class: "scroll", tabindex: "0"}, made);
const percent = x => x === undefined ? "" : x < 1e-12 ? "< 1e-10 %" : `${formatted(100 * x, 2)} %`;

// Frequencies with what is known of their errors; a row shows its motion.
function modeTable(content, choose) {
  const {modes} = content;
  const known = key => modes.some(mode => mode[key] !== undefined);
  const columns = [["mode", mode => String(mode.number)],
                   ["frequency, Hz", mode => formatted(mode.frequency_Hz, 6)]];
  if (known("estimate")) columns.push(["estimated error", mode => percent(mode.estimate)]);
  if (known("bound")) columns.push(["bound", mode => percent(mode.bound)]);
  if (known("diameters")) columns.push(["nodal diameters", mode => String(mode.diameters ?? "")]);
  columns.push(["kind", mode => mode.kind]);  // last: a small window shows the errors
  const made = table(columns.map(([name]) => name), modes.map(mode => columns.map(([, text]) => text(mode))));
  const n = content.surface ? content.surface.motions.length : 0;
  [...made.tBodies[0].rows].forEach((row, i) => {
    if (i >= n - content.surface?.motions.filter(m => m.kind === "squeal").length) return;
    row.dataset.motion = i;
    row.tabIndex = 0;
    row.addEventListener("click", () => choose(i));
    row.addEventListener("keydown", event => { if (event.key === "Enter") choose(i); });
  });
  return made;
}

function errorNote(content) {
  const certified = content.modes.some(mode => mode.estimate !== undefined);
  if (!certified && content.certified_support.length)
    return note(`The reduction estimated its errors for the support "${content.certified_support.join(", ")}"; ` +
                `this body is held otherwise (${content.support.join(", ") || "free"}), so none stands here.`);
  if (!certified) return note("The reduced file with its error estimates was not beside the body.");
  const bounded = content.modes.some(mode => mode.bound !== undefined);
  return note("Errors are those of the reduction against its finite-element model, relative to the frequency: " +
              "an estimate" + (bounded ? ", and a bound as far up as the count of eigenvalues says that no mode is missing." :
              "; that no mode is missing was not checked: [reduce] sylvester = true counts them and adds bounds."));
}

function countTable(counts) {
  const rows = counts.map(count => [count.of, formatted(count.up_to_Hz, 6), String(count.expected), String(count.found),
                                    String(count.expected - count.found)]);
  return table(["counted", "up to, Hz", "in the FE model", "found", "missing"], rows);
}

// A box that turns one thing in the picture on and off.
function checkbox(viewer, text, key) {
  const input = element("input", {type: "checkbox"});
  input.checked = viewer[key];
  input.addEventListener("change", () => { viewer[key] = input.checked; viewer.paint(); });
  return element("label", {}, input, ` ${text}`);
}

// Buttons to look from somewhere.
function directions(viewer) {
  const from = (text, turn, tilt) => {
    const button = element("button", {type: "button"}, text);
    button.addEventListener("click", () => { Object.assign(viewer, {turn, tilt, zoom: 1}); viewer.paint(); });
    return button;
  };
  return [from("from above", 0, 0), from("from the side", 0, Math.PI / 2), from("oblique", -0.5, 1.05)];
}

function viewerControls(viewer, motions, choose) {
  const select = element("select", {"aria-label": "Motion"}, ...motions.map((motion, i) =>
    element("option", {value: i}, `${motion.name}, ${formatted(motion.frequency_Hz, 6)} Hz`)));
  select.addEventListener("change", () => choose(Number(select.value)));
  const play = element("button", {type: "button"}, "Play");
  play.addEventListener("click", () => {
    viewer.play(!viewer.running);
    play.textContent = viewer.running ? "Pause" : "Play";
  });
  const amplitude = element("input", {type: "range", min: 0, max: 0.5, step: 0.01, value: viewer.amplitude});
  amplitude.addEventListener("input", () => { viewer.amplitude = Number(amplitude.value); viewer.paint(); });
  return {select, play, bar: element("div", {class: "controls"}, play, select,
    element("label", {}, "amplitude ", amplitude), checkbox(viewer, "mesh", "showMesh"), checkbox(viewer, "nodal lines", "showNodes"),
    ...directions(viewer))};
}

function drawModes(content) {
  const surface = content.surface, motions = surface ? surface.motions : [];
  const canvas = element("canvas", {tabindex: "0", role: "img", id: "viewer",
    "aria-label": "The body in motion; arrow keys turn it, plus and minus zoom"});
  let viewer, controls, rows;
  const legend = note("");
  const choose = i => {
    viewer.show(motions[i]);
    controls.select.value = i;
    for (const row of rows.tBodies[0].rows) row.classList.toggle("chosen", row.dataset.motion === String(i));
    legend.textContent = `Colour: displacement along ${"xyz"[viewer.motion.component]}, orange along it and blue ` +
      `against it; ${viewer.motion.im ? "the motion travels." : "dark where it is zero."}`;
  };
  rows = modeTable(content, choose);
  const side = element("div", {}, scrolled(rows), errorNote(content));
  if (content.counts) side.append(scrolled(countTable(content.counts)));
  if (!surface) return section("modes", "Modes", side);
  viewer = new Viewer(canvas, surface);
  window.viewer = viewer;
  controls = viewerControls(viewer, motions, choose);
  const figure = element("figure", {}, canvas, controls.bar, legend,
    note("Drag or use the arrow keys to turn, wheel or + and - to zoom."));
  if (surface.left_out) figure.append(note(`${surface.left_out} modes are not drawn, to keep this page small.`));
  section("modes", "Modes", element("div", {class: "viewer"}, figure, side));
  viewer.listen();
  choose(firstMotion(content));
}

// What a reader came for: the squeal if there is one, else the first elastic mode.
function firstMotion(content) {
  const motions = content.surface.motions;
  const squeal = motions.findIndex(motion => motion.kind === "squeal");
  const elastic = motions.findIndex(motion => motion.frequency_Hz > 1);
  return squeal >= 0 ? squeal : Math.max(0, elastic);
}

function mapFigures({map}) {
  const label = `${map.parameter}${map.unit && map.unit !== "1" ? `, ${map.unit}` : ""}`;
  const x = {label: speedAxis.label, values: map.speeds}, y = {label, values: map.values};
  return [heatMap({x, y, z: map.growth, unit: "1/s",
                   title: "Stability map: growth rate of the least stable oscillation; the line is the limit of stability"})];
}

function cycleFigures(content) {
  const {transient, branch} = content, made = [];
  if (transient && transient.envelope.some(v => v > 0))
    made.push(plot({title: `Envelope of the pad velocity at ${formatted(transient.speed)} rad/s (${transient.integrator})`,
                    x: {label: "time, s"}, y: {label: "pad velocity, m/s", log: true},
                    series: [{x: transient.t, y: transient.envelope, colour: 0}]}));
  if (transient) {
    const band = (key, colour, name) => ({x: transient[key].t, low: transient[key].least, high: transient[key].largest, colour, name});
    const {tail} = transient, cycle = chosenCycle(content);
    const first = cycle ? tail.t.findIndex(t => t > tail.t.at(-1) - 6 / cycle.frequency_Hz) : 0;
    const last = values => values.slice(Math.max(0, first));
    made.push(plot({title: "Normal forces of the first pad pair", x: {label: "time, s"}, y: {label: "normal force, N"},
                    bands: [band("N_up", 0, "upper pad"), band("N_lo", 1, "lower pad")]}));
    if (tail.t.length > 1) {
      made.push(plot({title: "Orbit of the upper pad in the last periods", height: 320,
                      x: {label: "pad displacement, mm"}, y: {label: "pad velocity, m/s"},
                      series: [{x: tail.displacement.map(u => 1e3 * u), y: tail.velocity, width: 1, colour: 0}]}));
      made.push(plot({title: "Normal forces in the last periods", x: {label: "time, s"}, y: {label: "normal force, N"},
                      series: [{x: last(tail.t), y: last(tail.N_up), colour: 0, name: "upper pad"},
                               {x: last(tail.t), y: last(tail.N_lo), colour: 1, dash: "6 3", name: "lower pad"}]}));
    }
  }
  if (branch) {
    const stable = branch.stable.map(Boolean);
    const gap = branch.second_part, speed = withGap(branch.speed, gap);
    const pick = wanted => withGap(branch.pad_velocity.map((v, i) => stable[i] === wanted ? v : NaN), gap);
    made.push(plot({title: "Limit cycles over the speed", x: speedAxis, y: {label: "pad velocity, m/s"},
                    series: [{x: speed, y: pick(true), colour: 0, marker: "circle", name: "stable"},
                             ...(stable.includes(false) ? [{x: speed, y: pick(false), colour: 1, dash: "4 4",
                                                            marker: "circle", hollow: true, name: "not stable"}] : [])]}));
  }
  if (content.spectrum)
    made.push(plot({title: "Spectrum of the pad velocity over the last periods" +
                           (content.limit_cycle?.doubt ? " of a transient that has not settled" : ""),
                    x: {label: "frequency, Hz"}, y: {label: "amplitude, m/s", log: true},
                    series: [{x: content.spectrum.frequency_Hz, y: content.spectrum.amplitude, width: 1.2}]}));
  return made;
}

// No line leads from the part of a curve before the index to the one behind it.
function withGap(values, index) {
  return index == null ? values : [...values.slice(0, index), NaN, ...values.slice(index)];
}

// What a transient has not settled at is no limit cycle where one was found as such.
function chosenCycle({limit_cycle, limit_cycle_direct}) {
  return limit_cycle && !limit_cycle.doubt ? limit_cycle : limit_cycle_direct ?? limit_cycle;
}

function cycleTable(content) {
  const rows = [["limit_cycle", "end of the transient"], ["limit_cycle_direct", "periodic motion, found as such"]]
    .filter(([key]) => content[key]).map(([key, name]) => {
      const cycle = content[key];
      return [name + (cycle.doubt && `, ${cycle.doubt}`), formatted(cycle.speed, 5), formatted(cycle.frequency_Hz, 6), formatted(cycle.pad_velocity, 5),
              formatted(1e3 * cycle.pad_displacement, 5), `${formatted(cycle.N_min, 4)} … ${formatted(cycle.N_max, 4)}`];
    });
  return rows.length ? scrolled(table(["limit cycle", "speed, rad/s", "frequency, Hz", "pad velocity, m/s",
                                       "pad displacement, mm", "normal force, N"], rows)) : "";
}

// The motion over the last rotations: how large, at which lines, and how it changes as the disc turns.
function drawStatistics({statistics}) {
  const {lines, rms_over_angle} = statistics, n = rms_over_angle.length;
  const figures_of = [["rotation speed, rad/s", formatted(statistics.speed, 5)],
                      ["effective pad velocity, m/s", formatted(statistics.rms_velocity, 4)],
                      ["largest pad velocity, m/s", formatted(statistics.peak_velocity, 4)],
                      ["largest pad displacement, mm", formatted(1e3 * statistics.peak_displacement, 4)],
                      ["normal force, N", `${formatted(statistics.N_min, 4)} … ${formatted(statistics.N_max, 4)}`],
                      ["modulation by the rotation", percent(statistics.modulation)]];
  const rows = lines.map(line => [formatted(line.frequency_Hz, 6), formatted(line.amplitude, 4), formatted(line.rotations, 4)]);
  section("statistics", `Motion over the last ${statistics.n_rotations} rotations${statistics.doubt && `, ${statistics.doubt}`}`,
    scrolled(table(["quantity", "value"], figures_of)),
    scrolled(table(["line, Hz", "amplitude, m/s", "rotations from the strongest"], rows)),
    figures(plot({title: "Effective pad velocity while the disc turns, mean over the rotations",
                  x: {label: "angle of the disc, degrees"}, y: {label: "pad velocity, m/s", low: 0, high: 1.1 * Math.max(...rms_over_angle)},
                  series: [{x: rms_over_angle.map((_, i) => (i + 0.5) * 360 / n), y: rms_over_angle, colour: 0, marker: "circle"}]})));
}

function selectionFigure(selection) {
  const path = (key, colour, marker, name) => ({x: selection[key].map(s => s.size), y: selection[key].map(s => s.error),
                                                colour, marker, name});
  const series = [path("modes_only", 0, "circle", "modes alone"),
                  path("with_interface_modes", 2, "triangle", "with interface modes")].filter(s => s.x.length);
  const sizes = series.flatMap(s => s.x);
  const line = {x: [Math.min(...sizes), Math.max(...sizes)], y: [selection.tolerance, selection.tolerance], colour: 5,
                dash: "5 4", name: "asked for"};
  return plot({title: `Body: largest error of the responses at ${selection.loads.join(", ")} up to ` +
                      `${formatted(selection.up_to_Hz)} Hz; ${selection.chosen} modes were chosen`,
               x: {label: "modes in the body"}, y: {label: "relative error", log: true}, series: [...series, line]});
}

function estimateFigure(modes) {
  const known = key => modes.filter(mode => mode[key] > 0);
  const curve = (key, colour, marker, name) => ({x: known(key).map(m => m.frequency_Hz), y: known(key).map(m => m[key]),
                                                 colour, marker, line: false, name});
  const series = [curve("estimate", 0, "circle", "estimate"), curve("bound", 1, "triangle", "bound")]
    .filter(s => s.x.length);
  return series.length && plot({title: "Reduction: error of each frequency against the FE model",
                                x: {label: "frequency, Hz"}, y: {label: "relative error", log: true}, series});
}

function benchmarkFigure(studies) {
  const markers = ["circle", "square", "triangle"];
  const curve = (study, whose, k, more) => {
    const points = study.tolerances.map(each => each[whose]).filter(point => point);
    return {x: points.map(p => p.cost_s), y: points.map(p => p.error), colour: k % 6, ...more};
  };
  const series = studies.flatMap((study, k) => [
    curve(study, "hand", k, {name: `${study.case}, by hand`, marker: markers[k % 3], hollow: true}),
    curve(study, "chosen", k, {name: `${study.case}, by tolerance`, marker: "star", line: false})]);
  return plot({title: "Whole program: error reached over time spent", x: {label: "CPU time, s", log: true},
               y: {label: "relative error of the frequencies", log: true}, series});
}

let page;
const content = () => page;

function drawPage() {
  page = JSON.parse(document.getElementById("content").textContent);
  const benchmark = JSON.parse(document.getElementById("benchmark").textContent);
  document.getElementById("title").textContent = page.title;
  const cycle = chosenCycle(page);
  const key = [page.modes && `${page.modes.length} modes`,
               page.groups && `${page.groups.length} groups`,
               page.critical && page.critical.words,
               !page.critical && page.stability && (page.stability === "unstable in the whole range" ? "unstable at all speeds"
                 : `stability over the speed: ${page.stability}`),
               cycle && `pad velocity ${formatted(cycle.pad_velocity)} m/s at ${formatted(cycle.speed)} rad/s` +
                 (cycle.doubt && ` (${cycle.doubt === "not settled" ? "end of the transient, " : ""}${cycle.doubt})`)];
  document.getElementById("key-figures").textContent = key.filter(Boolean).join(" · ");
  if (page.modes) drawModes(page);
  if (page.groups) drawGroups(page);
  if (page.responses) drawResponses(page.responses);
  if (page.campbell) section("campbell", "Stability over the speed", figures(...campbellFigures(page)));
  if (page.unstable_modes) section("modes-of-squeal", "Unstable modes", unstableModesTable(page), figures(...unstableModesFigures(page)));
  if (page.rotation) section("rotation", "Stability of the turning disc", figures(...rotationFigures(page)));
  if (page.gradients) section("gradients", "What to change", gradientsTable(page));
  if (page.map) section("map", "Stability map", figures(...mapFigures(page)));
  const cycles = cycleFigures(page);
  if (cycles.length || cycle) section("limit-cycle", "Limit cycle", cycleTable(page), figures(...cycles));
  if (page.spectrogram) section("orders", "Spectrogram and order tracks", figures(...orderFigures(page)));
  if (page.statistics) drawStatistics(page);
  const errors = [page.modes && estimateFigure(page.modes), page.selection && selectionFigure(page.selection),
                  benchmark && benchmarkFigure(benchmark)].filter(Boolean);
  if (errors.length) section("errors", "Size and time against error", figures(...errors));
  section("summary", "Summary", figures(...page.tables.map(({title, header, rows}) =>
    element("div", {}, element("h3", {}, title), scrolled(table(header, rows))))));
  const origin = page.provenance;
  section("origin", "Origin", note(`Written by Chladni ${page.version}.` + (origin ? ` Body: ${origin.versions}; ` +
    `${origin.ranks} rank(s); mesh checksum ${origin.mesh_checksum}.` : "") +
    (page.mesh_checksum ? ` Mesh checksum ${page.mesh_checksum}.` : "")),
    ...(page.scene ? [element("h3", {}, "Scene"), element("pre", {}, page.scene)] : []));
}

try {
  drawPage();
  document.body.dataset.state = "drawn";
} catch (error) {
  document.body.dataset.state = "failed";
  document.getElementById("sections").prepend(element("p", {}, `This page could not be drawn: ${error.message}`));
  throw error;
}
