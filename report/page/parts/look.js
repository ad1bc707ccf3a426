// Looking closer at a plot: zoom, pan, the values under the pointer, and files of what is shown.

const usage = "Drag a box to zoom, Shift and drag to move, Ctrl and wheel to zoom, double click for the whole.";
const unitOf = label => label.includes(", ") ? label.slice(label.lastIndexOf(", ") + 2) : "";
const quantityOf = label => label.includes(", ") ? label.slice(0, label.lastIndexOf(", ")) : label;

function told(axis, value) {
  const unit = unitOf(axis.label);
  if (unit === "rad/s") return `${quantityOf(axis.label)} ${speedText(value)}`;
  return `${quantityOf(axis.label)} ${formatted(value)}${unit ? ` ${unit}` : ""}`;
}

// Zoomed by a factor about a place (u, v) of [0, 1]^2.
function zoom(shown, factor, {u, v} = {u: 0.5, v: 0.5}) {
  const {x, y} = shown.state;
  shown.show(x.part(u - u * factor, u + (1 - u) * factor), y.part(v - v * factor, v + (1 - v) * factor));
}

function move(shown, {x, y}, du, dv) {
  shown.show(x.part(-du, 1 - du), y.part(-dv, 1 - dv));
}

// The point of a curve that is nearest to a place of the picture, within a thumb's width.
function nearestPoint(shown, px, py) {
  const {toX, toY, box} = shown.frame;
  let best = null, least = 30;
  for (const one of shown.options.points ?? []) {
    for (let i = 0; i < one.x.length; ++i) {
      const at = {one, i, px: toX(one.x[i]), py: toY(one.y[i])}, distance = Math.hypot(at.px - px, at.py - py);
      if (!(distance < least) || at.px < box.left - 1 || at.px > box.left + box.width + 1) continue;
      [best, least] = [at, distance];
    }
  }
  return best;
}

function readAt(shown, {u, v}, px, py) {
  const {options, state, svg, readout} = shown;
  svg.querySelector(".mark")?.remove();
  const x = state.x.value(u), y = state.y.value(v), near = nearestPoint(shown, px, py);
  const here = `${told(state.x, x)}, ${told(state.y, y)}`;
  const more = options.valueAt ? options.valueAt(x, y) : "";
  if (near) svg.append(svgElement("circle", {cx: near.px, cy: near.py, r: 6, class: "mark"}));
  const name = near && (near.one.said ?? near.one.name ?? "");
  const withUnit = (axis, value) => `${formatted(value, 5)}${unbroken}${unitOf(axis.label)}`.trim();
  const found = near ? `${name ? `${name}: ` : "nearest point: "}${withUnit(state.x, near.one.x[near.i])}, ${withUnit(state.y, near.one.y[near.i])}` : "";
  readout.textContent = [here, more, found].filter(Boolean).join(" · ");
}

// Where an event is: (u, v) in the plot, and in pixels.
function placeOf(shown, event) {
  const {svg, frame: {box}} = shown, around = svg.getBoundingClientRect();
  const px = event.clientX - around.left, py = event.clientY - around.top;
  const u = (px - box.left) / box.width, v = 1 - (py - box.top) / box.height;
  return {px, py, u, v, inside: u >= 0 && u <= 1 && v >= 0 && v <= 1};
}

// A long flat box zooms along one axis alone.
function zoomToBox(shown, from, to) {
  const {box} = shown.frame, wide = Math.abs(to.px - from.px) > 12, high = Math.abs(to.py - from.py) > 12;
  if (!wide && !high) return;
  const {x, y} = shown.state, ordered = (a, b) => [Math.max(0, Math.min(a, b)), Math.min(1, Math.max(a, b))];
  shown.show(wide ? x.part(...ordered(from.u, to.u)) : x, high ? y.part(...ordered(from.v, to.v)) : y);
}

function drawBox(shown, from, to) {
  const {svg, frame: {box}} = shown;
  svg.querySelector(".chosen-box")?.remove();
  const within = (value, low, size) => Math.max(low, Math.min(low + size, value));
  const x0 = within(from.px, box.left, box.width), x1 = within(to.px, box.left, box.width);
  const y0 = within(from.py, box.top, box.height), y1 = within(to.py, box.top, box.height);
  svg.append(svgElement("rect", {x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0),
                                 class: "chosen-box"}));
}

function lookCloser(shown) {
  const {svg, readout} = shown;
  let start = null;
  svg.addEventListener("pointerdown", event => {
    const at = placeOf(shown, event), isFinger = event.pointerType === "touch";
    if (!at.inside || event.button) return;
    readAt(shown, at, at.px, at.py);
    if (isFinger && !svg.classList.contains("closer")) return;  // the page scrolls
    start = {...at, moves: event.shiftKey || isFinger, state: {...shown.state}};
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", event => {
    const at = placeOf(shown, event);
    if (start?.moves) move(shown, start.state, at.u - start.u, at.v - start.v);
    else if (start) drawBox(shown, start, at);
    else if (at.inside) readAt(shown, at, at.px, at.py);
  });
  svg.addEventListener("pointerup", event => {
    if (start && !start.moves) zoomToBox(shown, start, placeOf(shown, event));
    svg.querySelector(".chosen-box")?.remove();
    start = null;
  });
  svg.addEventListener("pointercancel", () => { start = null; });
  svg.addEventListener("pointerleave", () => {
    svg.querySelector(".mark")?.remove();
    readout.textContent = "";
  });
  svg.addEventListener("dblclick", shown.whole);
  svg.addEventListener("wheel", event => {
    if (!event.ctrlKey) return;  // the page scrolls
    event.preventDefault();
    const at = placeOf(shown, event);
    zoom(shown, Math.exp(event.deltaY * 0.002), at);
  }, {passive: false});
  listenToKeys(shown);
}

function listenToKeys(shown) {
  const step = 0.15, moves = {ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]};
  shown.svg.addEventListener("keydown", event => {
    if (moves[event.key]) move(shown, shown.state, ...moves[event.key]);
    else if (event.key === "+") zoom(shown, 1 / 1.4);
    else if (event.key === "-") zoom(shown, 1.4);
    else if (event.key === "0") shown.whole();
    else return;
    event.preventDefault();
  });
}

// Buttons under a plot; those of `choices`, {text: y axis}, change the scale.
function toolsOf(shown) {
  const {options} = shown;
  const tools = [button("+", () => zoom(shown, 1 / 1.4), "zoom in"), button("−", () => zoom(shown, 1.4), "zoom out"),
               button("whole", shown.whole, usage)];
  const choose = axis => { options.y = axis; press(); shown.whole(); };
  const choices = Object.entries(options.choices ?? {}).map(([text, axis]) => [axis, button(text, () => choose(axis))]);
  const press = () => { for (const [axis, made] of choices) made.setAttribute("aria-pressed", String(axis === options.y)); };
  press();
  const draw = (svg, width) => drawChart(svg, options, shown.state, width, true);
  return [...tools, ...choices.map(([, made]) => made), ...filesOf(options.title, draw, options.csv)];
}

// Buttons that give the picture, drawn for paper into an SVG element of a width, and its numbers as files.
function filesOf(title, draw, csv) {
  const name = fileName(title), made = [button("SVG", () => save(`${name}.svg`, "image/svg+xml", svgText(title, draw)), "save this picture")];
  if (csv) made.push(button("CSV", () => save(`${name}.csv`, "text/csv", csvText(csv())), "save the numbers"));
  return made;
}

// The picture as other programs show it too: with the numbers of its colours.
function svgText(title, draw) {
  const width = 900, svg = svgElement("svg", {width}), paper = element("div", {class: "paper"});
  document.body.append(paper);
  draw(svg, width);
  svg.setAttribute("viewBox", `0 0 ${width} ${svg.getAttribute("height")}`);
  const rules = "text{font:12px 'DejaVu Sans',Arial,sans-serif;fill:var(--ink)} .label{font-size:10px} .frame{fill:none;stroke:var(--faint)} " +
    ".grid{stroke:var(--line);fill:none} .zero,.tick{stroke:var(--ink)} .halo{paint-order:stroke;stroke:var(--ground);stroke-width:3px}";
  svg.prepend(svgElement("title", {}, title), svgElement("style", {}, rules),
              svgElement("rect", {width: "100%", height: "100%", fill: "var(--ground)"}));
  const text = new XMLSerializer().serializeToString(svg)
    .replace(/var\((--[a-z0-9]+)\)/g, (all, name) => `#${pageColour(name, paper).map(c => c.toString(16).padStart(2, "0")).join("")}`);
  paper.remove();
  return text;
}

// Rows of texts and numbers, as spreadsheets read them.
function csvText(rows) {
  const cell = value => value === null || value === undefined || Number.isNaN(value) ? ""
    : /[",\n]/.test(String(value)) ? `"${String(value).replace(/"/g, '""')}"` : String(value);
  return rows.map(row => row.map(cell).join(",")).join("\r\n") + "\r\n";
}

// Curves over the same places share a column of them; each other curve has two columns of its own.
function csvOfSeries(x, y, series) {
  const named = series.map((one, k) => ({...one, title: one.said || one.name || one.label || `curve ${k + 1}`}));
  const groups = [];
  for (const one of named) {
    const group = groups.find(([first]) => first.x.length === one.x.length && first.x.every((v, i) => Object.is(v, one.x[i])));
    if (group) group.push(one);
    else groups.push([one]);
  }
  const columns = groups.flatMap(group => [[groups.length > 1 && group.length === 1 ? `${group[0].title}: ${x.label}` : x.label, ...group[0].x],
                                           ...group.map(one => [`${one.title}: ${y.label}`, ...one.y])]);
  const n = Math.max(0, ...columns.map(column => column.length));
  return Array.from({length: n}, (_, i) => columns.map(column => column[i]));
}
