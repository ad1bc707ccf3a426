// The modes of the body: table, and the body in motion.

// Frequencies with what is known of their errors; a row shows its motion.
function modeTable(content, choose) {
  const {modes} = content;
  const known = key => modes.some(mode => mode[key] !== undefined);
  const columns = [["mode", mode => String(mode.number)],
                   ["frequency, Hz", mode => formatted(mode.frequency_Hz, 6)]];
  if (known("estimate")) columns.push(["estimated error", mode => percent(mode.estimate)]);
  if (known("bound")) columns.push(["bound", mode => percent(mode.bound)]);
  if (known("diameters")) columns.push(["shape", longName]);
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
  const from = (text, turn, tilt) => button(text, () => { Object.assign(viewer, {turn, tilt, zoom: 1}); viewer.paintAll(); });
  return [from("from above", 0, 0), from("from the side", 0, Math.PI / 2), from("oblique", -0.5, 1.05)];
}

// "Mode 7 (3, 0), 1672.3 Hz".
function motionName(motion, mode) {
  const shape = motion.kind !== "squeal" && shortName(mode);
  return `${withRpm(motion.name)}${shape ? ` ${shape}` : ""}, ${formatted(motion.frequency_Hz, 6)} Hz`;
}

function viewerControls(viewer, {surface: {motions}, modes}, choose) {
  const select = element("select", {"aria-label": "Motion"},
                         ...motions.map((motion, i) => element("option", {value: i}, motionName(motion, modes[i]))));
  select.addEventListener("change", () => choose(Number(select.value)));
  const play = button("Play", () => {
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
  controls = viewerControls(viewer, content, choose);
  const figure = element("figure", {}, canvas, controls.bar, legend,
    note(howToTurn()));
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
