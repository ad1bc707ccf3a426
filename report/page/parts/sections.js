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

const scrolled = (made, more = "") => element("div", {class: `scroll${more && ` ${more}`}`, tabindex: "0"}, made);
const percent = x => x === undefined ? "" : x < 1e-12 ? "< 1e-10 %" : `${formatted(100 * x, 2)} %`;

// `shared`: what maps beside each other have in common, and whose map it is.
function mapFigures({map}, shared = {}) {
  const label = `${map.parameter}${map.unit && map.unit !== "1" ? `, ${map.unit}` : ""}`, whose = shared.label ? ` of ${shared.label}` : "";
  const x = {...speedAxis, values: map.speeds}, y = {label, values: map.values};
  return [heatMap({x, y, z: map.growth, unit: "1/s", quantity: "growth rate", largest: shared.largest,
                   title: `Stability map${whose}: growth rate of the least stable oscillation; the line is the limit of stability`})];
}

// "squeals from 13.35 rad/s (127.5 rpm), at 1695 Hz"
const whereItSqueals = ({words}) => withRpm(words);
const unitsKept = text => text.replace(/(\d) (rad\/s|Hz|m\/s|dB)/g, `$1${unbroken}$2`);

// What a reader wants to know first.
function keyFigures(run) {
  const cycle = chosenCycle(run);
  const key = [run.modes && `${run.modes.length} modes`,
               run.groups && `${run.groups.length} groups`,
               run.critical && whereItSqueals(run.critical),
               !run.critical && run.stability && (run.stability === "unstable in the whole range" ? "unstable at all speeds"
                 : `stability over the speed: ${run.stability}`),
               cycle && `pad velocity ${formatted(cycle.pad_velocity)} m/s at ${speedText(cycle.speed)}` +
                 (cycle.doubt && ` (${cycle.doubt === "not settled" ? "end of the transient, " : ""}${cycle.doubt})`),
               loudest(run) !== undefined && `${dB(loudest(run))} dB(A) at the loudest microphone`];
  return unitsKept(key.filter(Boolean).join(" · "));
}

// All that one run has to say.
function drawRun(run, benchmark) {
  if (run.modes) drawModes(run);
  if (run.groups) drawGroups(run);
  if (run.responses) drawResponses(run.responses);
  const named = ({of}) => `Stability over the speed${of ? `: ${of}` : ""}`;
  if (run.campbell) section("campbell", named(run.campbell), figures(...campbellFigures(run)));
  if (run.frozen) section("frozen", named(run.frozen), figures(...campbellFigures({campbell: run.frozen})));
  if (run.unstable_modes) section("modes-of-squeal", "Unstable modes", unstableModesTable(run), figures(...unstableModesFigures(run)));
  if (run.rotation) section("rotation", "Stability of the turning disc", figures(...rotationFigures(run)));
  if (run.gradients) drawGradients(run);
  if (run.map) section("map", "Stability map", figures(...mapFigures(run)));
  const cycles = cycleFigures(run);
  if (cycles.length || chosenCycle(run)) section("limit-cycle", "Limit cycle", cycleTable(run), figures(...cycles));
  if (run.sound) drawSound(run);
  if (run.spectrogram)
    section("orders", "Run-up: spectrogram, waterfall and orders", ...orderPictures(run.spectrogram), figures(...orderFigures(run.spectrogram)));
  if (run.statistics) drawStatistics(run);
  const errors = [run.modes && estimateFigure(run.modes), run.selection && selectionFigure(run.selection),
                  benchmark && benchmarkFigure(benchmark)].filter(Boolean);
  if (errors.length) section("errors", "Size and time against error", figures(...errors));
  section("summary", "Summary", figures(...run.tables.map(({title, header, rows}) =>
    element("div", {}, element("h3", {}, title), scrolled(table(header, rows), "texts")))));
  drawOrigin(run);
}

function drawOrigin(run) {
  const origin = run.provenance;
  section("origin", "Origin", note(`Written by Chladni ${run.version}.` + (origin ? ` Body: ${origin.versions}; ` +
    `${origin.ranks} rank(s); mesh checksum ${origin.mesh_checksum}.` : "") +
    (run.mesh_checksum ? ` Mesh checksum ${run.mesh_checksum}.` : "")),
    ...(run.scene ? [element("h3", {}, "Scene"), element("pre", {}, run.scene)] : []));
}

// The comparison, then all of one run, which the reader chooses.
function drawRuns(runs, benchmark) {
  drawComparison(runs);
  const kept = new Set(document.querySelectorAll("#sections > *, #contents > *"));
  const choices = runs.map((run, k) => button(run.label, () => choose(k)));
  const choose = chosen => {
    window.viewer?.play(false);
    for (const old of document.querySelectorAll("#sections > *, #contents > *")) if (!kept.has(old)) old.remove();
    choices.forEach((choice, k) => choice.setAttribute("aria-pressed", String(k === chosen)));
    said.textContent = keyFigures(runs[chosen]);
    drawRun(runs[chosen], benchmark);
  };
  const said = note(""), bar = element("div", {class: "runs"}, element("div", {class: "controls"}, "Run shown below ", ...choices), said);
  document.getElementById("sections").append(bar);
  kept.add(bar);
  choose(0);
}

function drawPage() {
  const page = JSON.parse(document.getElementById("content").textContent);
  const benchmark = JSON.parse(document.getElementById("benchmark").textContent);
  document.getElementById("title").textContent = page.title;
  if (page.runs) return drawRuns(page.runs, benchmark);
  document.getElementById("key-figures").textContent = keyFigures(page);
  drawRun(page, benchmark);
}

try {
  drawPage();
  document.body.dataset.state = "drawn";
} catch (error) {
  document.body.dataset.state = "failed";
  document.getElementById("sections").prepend(element("p", {}, `This page could not be drawn: ${error.message}`));
  throw error;
}
