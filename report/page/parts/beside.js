// The bodies of several runs in motion beside each other.

// The motions of a run by names that other runs have too: modes by their shapes, the squeal by what it is.
function namedMotions({surface, modes}) {
  const found = new Map(), seen = new Map();
  surface.motions.forEach((motion, i) => {
    const name = motion.kind === "squeal" ? motion.name.split(/ at |,/)[0].replace(/^Least stable$/, "Least stable oscillation") : longName(modes[i]);
    if (!name) return;
    const k = (seen.get(name) ?? 0) + 1;
    seen.set(name, k);
    found.set(`${name}${k > 1 ? `, no. ${k}` : ""}`, motion);
  });
  return found;
}

function bodyBeside(run, motions, others) {
  const canvas = element("canvas", {tabindex: "0", role: "img", "aria-label": `${run.label} in motion; arrow keys turn it, plus and minus zoom`});
  const viewer = new Viewer(canvas, run.surface), caption = element("figcaption");
  viewer.others = others;
  others.push(viewer);
  const show = name => {
    const motion = motions.get(name), said = motion.kind === "squeal" ? `${withRpm(motion.name)}, ` : "";
    viewer.show(motion);
    caption.textContent = `${run.label}: ${said}${formatted(motion.frequency_Hz, 6)} Hz`;
  };
  return {viewer, show, figure: element("figure", {}, canvas, caption)};
}

// Nothing where less than two runs can be drawn or no motion is in all of them.
function bodiesBeside(runs) {
  const drawn = runs.filter(run => run.surface?.motions.length && run.modes), motions = drawn.map(namedMotions), others = [];
  const names = drawn.length > 1 ? [...motions[0].keys()].filter(name => motions.every(of => of.has(name))) : [];
  if (!names.length) return [];
  const bodies = drawn.map((run, k) => bodyBeside(run, motions[k], others)), [{viewer}] = bodies;
  const select = element("select", {"aria-label": "Motion of all bodies"}, ...names.map(name => element("option", {}, name)));
  const choose = () => bodies.forEach(({show}) => show(select.value));
  const play = button("Play", () => {
    viewer.play(!viewer.running);
    play.textContent = viewer.running ? "Pause" : "Play";
  });
  select.addEventListener("change", choose);
  select.value = names.find(name => motions[0].get(name).kind === "squeal") ?? names.find(name => motions[0].get(name).frequency_Hz > 1) ?? names[0];
  const figures_of = figures(...bodies.map(({figure}) => figure));
  figures_of.classList.add("bodies");
  return [figures_of, () => { bodies.forEach(body => body.viewer.listen()); choose(); },
          element("div", {class: "controls"}, play, select, ...directions(viewer)),
          note(`${howToTurn()} All bodies turn together. The sign of a mode, and the angle of a pair of modes, are arbitrary.`)];
}
