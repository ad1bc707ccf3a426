// A mesh at rest with its groups: each has a colour, and its name beside it.

const mixed = (a, b, part) => a.map((v, c) => Math.round(v + part * (b[c] - v)));
const flat = colour => new Array(256).fill(colour);  // the same for any value
const styled = colour => `rgb(${colour.join(", ")})`;

// The drawing of each group: its triangles by their corners, its lines by their ends, its points.
function readGroups(content, surface) {
  const cells = unpacked(content.drawing.cells, Int32Array);
  const groupOfCell = unpacked(content.drawing.group_of_cell, Int32Array);
  const read = content.groups.map(group => ({...group, triangles: [], lines: [...unpacked(group.lines, Int32Array)],
                                             points: unpacked(group.points, Int32Array)}));
  const none = {triangles: [], lines: [], points: []};
  groupOfCell.forEach((g, k) => {
    const [a, b, c, d] = cells.subarray(4 * k, 4 * k + 4), group = read[g] ?? none;
    if (b === c && group === none) group.lines.push(a, b);
    if (b === c) return;
    group.triangles.push(a, b, c);
    if (c !== d) group.triangles.push(a, c, d);
  });
  for (const group of read) group.nodes = sample([...new Set([...group.triangles, ...group.lines, ...group.points])], 1500);
  surface.lines = Int32Array.from([]);
  surface.mesh = unpacked(content.drawing.edges, Int32Array);
  return {groups: read, none};
}

const sample = (list, most) => list.filter((_, i) => i % Math.ceil(list.length / most) === 0);

class GroupViewer extends Viewer {
  constructor(canvas, content) {
    super(canvas, content.drawing);
    Object.assign(this, readGroups(content, this.surface));
    const n = this.surface.mesh.length / 2;  // many lines would hide the colours
    Object.assign(this, {
      motion: {re: new Float32Array(3 * this.surface.n), im: null, component: 0, largest: 1}, amplitude: 0,
      showNodes: false, showMesh: n < 15000, showNames: true, chosen: -1, pointed: -1,
      owner: new Int32Array(1), whole: {centre: this.surface.centre, radius: this.surface.radius}});
    const ground = pageColour("--ground"), ink = pageColour("--ink"), faint = mixed(ground, ink, 0.1);
    const counts = {};
    for (const group of this.groups) {
      const isSurface = group.kind === "surface", k = counts[isSurface] = (counts[isSurface] ?? -1) + 1;
      // Surfaces pale and curves strong, so that a curve shows on the surface that it bounds.
      const colour = pageColour(`--c${isSurface ? (k + 5) % 6 : k % 5}`);
      group.colour = isSurface ? mixed(colour, ground, 0.55) : colour;
      group.palette = flat(group.colour);
    }
    this.none.palette = flat(faint);
    this.pale = flat(faint);
    this.thin = flat(mixed(ground, ink, 0.45));
    this.wire = flat(mixed(ground, ink, 0.35));
    this.accent = pageColour("--c1");
    this.strong = flat(this.accent);
  }

  get active() { return this.pointed >= 0 ? this.pointed : this.chosen; }

  paint() {
    this.clear();
    const {groups, none, active} = this;
    [...groups, none].forEach((group, g) => {
      this.painting = g < groups.length ? g : -1;
      const palette = active < 0 ? group.palette : g === active ? this.strong : this.pale;
      const t = group.triangles;
      for (let k = 0; k < t.length; k += 3) this.paintTriangle(t[k], t[k + 1], t[k + 2], palette);
    });
    this.paintEdges();
    groups.forEach((group, g) => { if (g !== active) this.paintLines(g, active < 0 ? group.palette : this.thin, active < 0 ? 5 : 3); });
    this.painting = -1;
    for (let k = 0; k < none.lines.length; k += 2) this.paintLine(none.lines[k], none.lines[k + 1], 3, this.thin);
    if (active >= 0) {  // seen through everything else
      this.lift = 4 * Math.max(this.canvas.width, this.canvas.height) * this.zoom;
      this.paintLines(active, this.strong, 7);
      this.lift = 0;
    }
    this.painter.putImageData(this.image, 0, 0);
    this.writeNames();
  }

  // The pixels of the edges stay those of the elements beside them.
  paintEdges() {
    const {owner, surface} = this, edges = this.showMesh ? surface.mesh : surface.rim;
    Object.assign(this, {owner: null, lift: -1.5});  // curves and points lie over them
    for (let k = 0; k < edges.length; k += 2) this.paintLine(edges[k], edges[k + 1], 1, this.wire);
    Object.assign(this, {owner, lift: 0});
  }

  paintLines(g, palette, thickness) {
    const {lines, points} = this.groups[g];
    this.painting = g;
    for (let k = 0; k < lines.length; k += 2) this.paintLine(lines[k], lines[k + 1], thickness, palette);
    this.lift += 2;  // over the lines that they end
    for (const point of points) this.paintLine(point, point, thickness + 4, palette);
    this.lift -= 2;
  }

  isSeen(node, g) {
    const px = Math.round(this.x[node]), py = Math.round(this.y[node]);
    if (px < 0 || py < 0 || px >= this.canvas.width || py >= this.canvas.height) return false;
    return this.owner[py * this.canvas.width + px] === g;
  }

  // Nodes of the group that are seen, each in another direction from their middle. Each group begins
  // elsewhere, so that names of concentric circles stand apart.
  placesOfName(g) {
    let seen = this.groups[g].nodes.filter(node => this.isSeen(node, g));
    if (!seen.length && g === this.active) seen = this.groups[g].nodes;  // behind others
    if (!seen.length) return [];
    const mean = value => seen.reduce((sum, node) => sum + value(node), 0) / seen.length;
    const mx = mean(node => this.x[node]), my = mean(node => this.y[node]);
    const reach = mean(node => Math.hypot(this.x[node] - mx, this.y[node] - my));
    return [0, 1, 2, 3, 4, 5, 6, 7].map(k => {
      const angle = 0.7 + 2.4 * g + Math.PI / 4 * k, tx = mx + reach * Math.cos(angle), ty = my + reach * Math.sin(angle);
      const distance = node => Math.hypot(this.x[node] - tx, this.y[node] - ty);
      const best = seen.reduce((a, b) => distance(b) < distance(a) ? b : a);
      return {x: this.x[best], y: this.y[best], right: Math.cos(angle) >= 0};
    });
  }

  boxOfName(place, width, size) {
    const {canvas, ratio} = this, away = 8 * ratio, wanted = place.right ? place.x + away : place.x - away - width;
    const left = Math.max(2, Math.min(canvas.width - width - 2, wanted));
    const base = Math.max(size, Math.min(canvas.height - 4, place.y + size / 3));
    return {left: left - 3, right: left + width + 3, top: base - size, bottom: base + size / 4, base};
  }

  // The active group's name alone, or all names that find room.
  writeNames() {
    const {painter, active, ratio, groups} = this, taken = [];
    this.named = [];
    const wanted = active >= 0 ? [active] : this.showNames ? [...groups.keys()] : [];
    const isFree = box => taken.every(other => box.left >= other.right || other.left >= box.right ||
                                               box.top >= other.bottom || other.top >= box.bottom);
    for (const g of wanted) {
      const size = (g === active ? 15 : 12) * ratio, name = groups[g].name;
      painter.font = `${g === active ? "bold " : ""}${size}px system-ui, "DejaVu Sans", sans-serif`;
      const width = painter.measureText(name).width;
      const box = this.placesOfName(g).map(place => this.boxOfName(place, width, size)).find(isFree);
      if (!box) continue;
      taken.push(box);
      this.named.push(name);
      this.writeName(name, box.left + 3, box.base);
    }
  }

  writeName(name, left, base) {
    const {painter, ratio} = this;
    painter.lineJoin = "round";
    painter.lineWidth = 4 * ratio;
    painter.strokeStyle = styled(pageColour("--panel"));
    painter.strokeText(name, left, base);
    painter.fillStyle = styled(pageColour("--ink"));
    painter.fillText(name, left, base);
  }

  // The group at a point of the screen; a curve near to it comes before the surface there.
  groupAt(event) {
    const box = this.canvas.getBoundingClientRect(), reach = Math.round(4 * this.ratio);
    const cx = Math.round((event.clientX - box.left) * this.canvas.width / box.width);
    const cy = Math.round((event.clientY - box.top) * this.canvas.height / box.height);
    let found = -1, nearest = Infinity;
    for (let dy = -reach; dy <= reach; ++dy) for (let dx = -reach; dx <= reach; ++dx) {
      const px = cx + dx, py = cy + dy;
      if (px < 0 || py < 0 || px >= this.canvas.width || py >= this.canvas.height) continue;
      const g = this.owner[py * this.canvas.width + px];
      if (g < 0) continue;
      const isSurface = this.groups[g].kind === "surface";
      if (isSurface && (dx || dy)) continue;
      const distance = Math.hypot(dx, dy) + (isSurface ? 2 * reach : 0);
      if (distance < nearest) [found, nearest] = [g, distance];
    }
    return found;
  }

  // Brings the group to the middle, as large as fits; -1 for the whole mesh.
  centreOn(g) {
    const {positions} = this.surface, nodes = g < 0 ? [] : this.groups[g].nodes;
    if (!nodes.length) {
      Object.assign(this, {zoom: 1});
      this.surface.centre = this.whole.centre;
      return this.paint();
    }
    const range = c => [Math.min(...nodes.map(n => positions[3 * n + c])), Math.max(...nodes.map(n => positions[3 * n + c]))];
    const ranges = [0, 1, 2].map(range);
    this.surface.centre = ranges.map(([low, high]) => (low + high) / 2);
    const radius = Math.hypot(...ranges.map(([low, high]) => (high - low) / 2));
    this.zoom = Math.max(1, Math.min(8, 0.6 * this.whole.radius / (radius || 1e-9)));
    this.paint();
  }
}

// 0.0312 m^2, or nothing where the size is not known.
function sizeOf(group) {
  if (!(group.size > 0)) return "";
  return `${formatted(group.size)} ${({volume: "m³", surface: "m²"})[group.kind] ?? "m"}`;
}

function saidOfGroup(group) {
  const ranges = group.extents.map(([low, high], c) =>
    `${"xyz"[c]} ${low === high ? formatted(low) : `${formatted(low)} to ${formatted(high)}`}`);
  const size = sizeOf(group);
  return `${group.name}: ${group.kind}, ${group.n_nodes} nodes${size ? `, ${size}` : ""}; ${ranges.join(", ")} m.`;
}

function groupTable(groups) {
  const made = table(["group", "kind", "nodes", "size"],
                     groups.map(group => [group.name, group.kind, String(group.n_nodes), sizeOf(group)]));
  [...made.tBodies[0].rows].forEach((row, g) => {
    row.dataset.group = g;
    row.tabIndex = 0;
    row.cells[0].classList.add("coloured");
    row.cells[0].prepend(element("span", {class: "swatch", style: `background: ${styled(groups[g].colour)}`}));
  });
  return made;
}

// A list whose rows show their groups, and a picture that shows the rows of its groups.
function connectGroups(viewer, rows, legend) {
  const show = () => {
    viewer.paint();
    const group = viewer.groups[viewer.active];
    legend.textContent = group ? saidOfGroup(group) : "Point at a group in the list or in the picture; a click keeps it.";
    for (const row of rows) {
      row.classList.toggle("chosen", row.dataset.group === String(viewer.chosen));
      row.classList.toggle("pointed", row.dataset.group === String(viewer.pointed));
    }
  };
  const point = g => { if (g !== viewer.pointed) { viewer.pointed = g; show(); } };
  const choose = g => { Object.assign(viewer, {chosen: g === viewer.chosen ? -1 : g, pointed: -1}); show(); };
  for (const row of rows) {
    const g = Number(row.dataset.group);
    row.addEventListener("pointerenter", event => { if (event.pointerType === "mouse") point(g); });
    row.addEventListener("pointerleave", () => point(-1));
    row.addEventListener("click", () => choose(g));
    row.addEventListener("keydown", event => { if (event.key === "Enter") choose(g); });
  }
  let start = null;
  const canvas = viewer.canvas;
  canvas.addEventListener("pointerdown", event => { start = event; point(-1); });
  canvas.addEventListener("pointermove", event => { if (!event.buttons) point(viewer.groupAt(event)); });
  canvas.addEventListener("pointerleave", () => point(-1));
  canvas.addEventListener("pointerup", event => {
    if (!start || Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) > 4) return;
    const g = viewer.groupAt(event);
    choose(g < 0 ? viewer.chosen : g);
    if (g >= 0) rows[g].scrollIntoView({block: "nearest"});
  });
  show();
}

function groupControls(viewer, rows) {
  const search = element("input", {type: "search", placeholder: "Find a group", "aria-label": "Find a group"});
  search.addEventListener("input", () => {
    for (const row of rows)
      row.hidden = !viewer.groups[row.dataset.group].name.toLowerCase().includes(search.value.toLowerCase());
  });
  const boxes = viewer.surface.mesh.length ? [checkbox(viewer, "mesh", "showMesh")] : [];
  return {search, bar: element("div", {class: "controls"}, ...boxes, checkbox(viewer, "names", "showNames"),
    button("centre on the group", () => viewer.centreOn(viewer.active)), button("whole mesh", () => viewer.centreOn(-1)),
    ...directions(viewer))};
}

function drawGroups(content) {
  const canvas = element("canvas", {tabindex: "0", role: "img", id: "viewer",
    "aria-label": "The mesh with its groups; arrow keys turn it, plus and minus zoom"});
  const viewer = new GroupViewer(canvas, content), legend = note("");
  window.viewer = viewer;
  const listed = groupTable(viewer.groups), rows = [...listed.tBodies[0].rows];
  const {search, bar} = groupControls(viewer, rows);
  const figure = element("figure", {}, canvas, bar, legend,
    note(howToTurn()));
  if (content.drawing.said) figure.append(note(content.drawing.said));
  const side = element("div", {}, element("div", {class: "controls"}, search), scrolled(listed));
  section("groups", "Groups", element("div", {class: "viewer"}, figure, side));
  viewer.listen();
  connectGroups(viewer, rows, legend);
}
