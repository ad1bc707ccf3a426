// The body in motion, painted pixel by pixel with a depth buffer: it needs no graphics card.

function unpacked(text, Type) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Type(bytes.buffer);
}

// Triangles and lines of cells [a b c d]; a triangle repeats its last corner, a line twice.
function splitCells(cells) {
  const triangles = [], lines = [], sides = new Map();
  const addSide = (a, b) => {
    const key = a < b ? `${a},${b}` : `${b},${a}`;
    sides.set(key, (sides.get(key) ?? 0) + 1);
  };
  for (let k = 0; k < cells.length; k += 4) {
    const [a, b, c, d] = cells.subarray(k, k + 4);
    if (b === c) { lines.push(a, b); continue; }
    triangles.push(a, b, c);
    if (c !== d) triangles.push(a, c, d);
    const corners = c === d ? [a, b, c] : [a, b, c, d];
    corners.forEach((corner, i) => addSide(corner, corners[(i + 1) % corners.length]));
  }
  const ends = wanted => [...sides].filter(([, n]) => wanted(n)).flatMap(([key]) => key.split(",").map(Number));
  return {triangles: Int32Array.from(triangles), lines: Int32Array.from(lines),
          rim: Int32Array.from(ends(n => n === 1)), mesh: Int32Array.from(ends(() => true))};
}

function readSurface(surface) {
  const positions = unpacked(surface.positions, Float32Array);
  const n = positions.length / 3, centre = [0, 0, 0];
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < n; ++i) for (let c = 0; c < 3; ++c) {
    low[c] = Math.min(low[c], positions[3 * i + c]);
    high[c] = Math.max(high[c], positions[3 * i + c]);
  }
  for (let c = 0; c < 3; ++c) centre[c] = (low[c] + high[c]) / 2;
  let radius = 0;
  for (let i = 0; i < positions.length; i += 3)
    radius = Math.max(radius, Math.hypot(...centre.map((middle, c) => positions[i + c] - middle)));
  return {n, positions, centre, radius: radius || 1, ...splitCells(unpacked(surface.cells, Int32Array))};
}

// Displacements of one motion, full scale 1, and the component that is coloured: the largest.
function readMotion(motion) {
  const re = Float32Array.from(unpacked(motion.re, Int16Array), v => v / 32767);
  const im = motion.im ? Float32Array.from(unpacked(motion.im, Int16Array), v => v / 32767) : null;
  const sums = [0, 0, 0];
  for (let i = 0; i < re.length; ++i) sums[i % 3] += re[i] ** 2 + (im ? im[i] ** 2 : 0);
  const component = sums.indexOf(Math.max(...sums));
  let largest = 1e-9;
  for (let i = component; i < re.length; i += 3) largest = Math.max(largest, Math.hypot(re[i], im ? im[i] : 0));
  return {re, im, component, largest};
}

const howToTurn = () => matchMedia("(pointer: coarse)").matches
  ? "Drag sideways to turn; tap the body to turn it in all directions, tap again to scroll the page. Two fingers zoom."
  : "Drag or use the arrow keys to turn; Ctrl and wheel, two fingers, or + and - zoom.";

// Viewers with the same `others` are turned, zoomed and played together.
class Viewer {
  constructor(canvas, surface) {
    Object.assign(this, {canvas, surface: readSurface(surface), turn: -0.5, tilt: 1.05, zoom: 1, amplitude: 0.12,
                         phase: 0, showMesh: false, showNodes: true, painted: 0, lift: 0, owner: null, others: []});
    if (this.surface.triangles.length === 0) Object.assign(this, {turn: 0, tilt: Math.PI / 2});  // beams: from the side
    this.x = new Float32Array(this.surface.n);
    this.y = new Float32Array(this.surface.n);
    this.z = new Float32Array(this.surface.n);
    this.value = new Float32Array(this.surface.n);
    this.nodalShade = matchMedia("(prefers-color-scheme: dark)").matches ? 2.5 : 0.35;
    this.palette = Array.from({length: 256}, (_, k) => divergingColour(k / 127.5 - 1));
  }

  show(motion) {
    this.motion = readMotion(motion);
    this.paint();
  }

  // Paints this one, and the others from where this one is looked at.
  paintAll() {
    const {turn, tilt, zoom, phase} = this;
    this.paint();
    for (const other of this.others) if (other !== this && other.motion) Object.assign(other, {turn, tilt, zoom, phase}).paint();
  }

  resize() {
    const ratio = Math.min(2, devicePixelRatio || 1), box = this.canvas.getBoundingClientRect();
    const width = Math.max(200, Math.round(box.width * ratio)), height = Math.round(width * 3 / 4);
    if (this.canvas.width === width && this.image) return;
    this.ratio = ratio;
    Object.assign(this.canvas, {width, height});
    this.painter = this.canvas.getContext("2d");
    this.image = this.painter.createImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
    if (this.owner) this.owner = new Int32Array(width * height);
  }

  // Displaced and turned nodes in pixels; orthographic.
  project() {
    const {surface, motion} = this, {positions, centre} = surface;
    const scale = this.amplitude * surface.radius, cos = Math.cos(this.phase), sin = Math.sin(this.phase);
    const ct = Math.cos(this.turn), st = Math.sin(this.turn), ci = Math.cos(this.tilt), si = Math.sin(this.tilt);
    const pixels = 0.46 * this.canvas.height * this.zoom / surface.radius;
    const displacement = [0, 0, 0];
    for (let i = 0; i < surface.n; ++i) {
      for (let c = 0; c < 3; ++c) {
        const k = 3 * i + c;
        displacement[c] = motion.re[k] * cos - (motion.im ? motion.im[k] * sin : 0);
      }
      this.value[i] = displacement[motion.component] / motion.largest;
      const x = positions[3 * i] - centre[0] + scale * displacement[0];
      const y = positions[3 * i + 1] - centre[1] + scale * displacement[1];
      const z = positions[3 * i + 2] - centre[2] + scale * displacement[2];
      const u = ct * x - st * y, v = st * x + ct * y;
      this.x[i] = this.canvas.width / 2 + pixels * u;
      this.y[i] = this.canvas.height / 2 - pixels * (ci * v + si * z);
      this.z[i] = pixels * (ci * z - si * v);  // towards the viewer
    }
  }

  clear() {
    this.resize();
    this.project();
    this.pixels.fill(0);
    this.depth.fill(-Infinity);
    this.owner?.fill(-1);
    this.painted = 0;
  }

  paint() {
    this.clear();
    const {triangles, rim, mesh, lines} = this.surface;
    for (let k = 0; k < triangles.length; k += 3) this.paintTriangle(triangles[k], triangles[k + 1], triangles[k + 2]);
    const edges = this.showMesh ? mesh : rim;
    for (let k = 0; k < edges.length; k += 2) this.paintLine(edges[k], edges[k + 1], 1);
    for (let k = 0; k < lines.length; k += 2) this.paintLine(lines[k], lines[k + 1], 7);
    for (let k = 0; k < lines.length; k += 2) this.paintLine(lines[k], lines[k + 1], 5, this.palette);
    this.painter.putImageData(this.image, 0, 0);
  }

  // Where `owner` is kept, each pixel tells the number `painting` of what was painted there last.
  paintTriangle(a, b, c, palette = this.palette) {
    const {x, y, z, value, depth, pixels, owner, painting} = this, width = this.canvas.width, height = this.canvas.height;
    const x0 = x[a], y0 = y[a], dx1 = x[b] - x0, dy1 = y[b] - y0, dx2 = x[c] - x0, dy2 = y[c] - y0;
    const area = dx1 * dy2 - dx2 * dy1;
    if (Math.abs(area) < 1e-6) return;
    const dz1 = z[b] - z[a], dz2 = z[c] - z[a], dv1 = value[b] - value[a], dv2 = value[c] - value[a];
    // Light from the viewer: the part of the normal that points there.
    const light = 0.62 + 0.38 * Math.abs(area) / Math.hypot(area, dy1 * dz2 - dy2 * dz1, dz1 * dx2 - dz2 * dx1);
    const left = Math.max(0, Math.ceil(Math.min(x0, x[b], x[c]))), right = Math.min(width - 1, Math.floor(Math.max(x0, x[b], x[c])));
    const top = Math.max(0, Math.ceil(Math.min(y0, y[b], y[c]))), bottom = Math.min(height - 1, Math.floor(Math.max(y0, y[b], y[c])));
    // A nodal line is about three pixels wide, however steep the value is.
    const slope = Math.hypot(dv1 * dy2 - dv2 * dy1, dv2 * dx1 - dv1 * dx2) / Math.abs(area);
    const nodal = this.showNodes ? Math.min(0.06, 1.5 * slope * this.ratio) : -1;
    for (let py = top; py <= bottom; ++py) {
      for (let px = left; px <= right; ++px) {
        const u = ((px - x0) * dy2 - (py - y0) * dx2) / area, v = ((py - y0) * dx1 - (px - x0) * dy1) / area;
        if (u < -1e-4 || v < -1e-4 || u + v > 1.0001) continue;
        const at = py * width + px, near = z[a] + u * dz1 + v * dz2;
        if (near <= depth[at]) continue;
        depth[at] = near;
        if (owner) owner[at] = painting;
        const here = value[a] + u * dv1 + v * dv2;
        const colour = palette[Math.max(0, Math.min(255, Math.round(127.5 + 127.5 * here)))];
        const shade = Math.abs(here) < nodal ? this.nodalShade * light : light;
        pixels[at] = 0xff000000 | colour[2] * shade << 16 | colour[1] * shade << 8 | colour[0] * shade;
        ++this.painted;
      }
    }
  }

  paintLine(a, b, thickness, palette) {
    const {x, y, z, depth, pixels, value, owner, painting} = this, width = this.canvas.width, height = this.canvas.height;
    const steps = Math.max(1, Math.ceil(Math.max(Math.abs(x[b] - x[a]), Math.abs(y[b] - y[a]))));
    const reach = (thickness - 1) / 2;
    for (let s = 0; s <= steps; ++s) {
      const part = s / steps, near = z[a] + part * (z[b] - z[a]) + (palette ? 3 : 1.5) + this.lift;
      const cx = Math.round(x[a] + part * (x[b] - x[a])), cy = Math.round(y[a] + part * (y[b] - y[a]));
      const here = value[a] + part * (value[b] - value[a]);
      const colour = palette ? palette[Math.max(0, Math.min(255, Math.round(127.5 + 127.5 * here)))] : [60, 66, 74];
      for (let dy = -reach; dy <= reach; ++dy) for (let dx = -reach; dx <= reach; ++dx) {
        const px = cx + dx, py = cy + dy;
        if (px < 0 || py < 0 || px >= width || py >= height) continue;
        const at = py * width + px;
        if (near <= depth[at]) continue;
        depth[at] = near;
        if (owner) owner[at] = painting;
        pixels[at] = 0xff000000 | colour[2] << 16 | colour[1] << 8 | colour[0];
        ++this.painted;
      }
    }
  }

  // Turning with one pointer or the arrow keys, zooming with two pointers, Ctrl and wheel, or + and -. One finger turns
  // about the axis alone, for its way up or down scrolls the page, until a tap gives all its ways to the body.
  listen() {
    const canvas = this.canvas, fingers = new Map();
    let start = null;
    const isTap = event => start && event.pointerType === "touch" && event.timeStamp - start.timeStamp < 400 &&
      Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 8;
    const spread = () => {
      const [one, other] = [...fingers.values()];
      return Math.hypot(one.x - other.x, one.y - other.y);
    };
    const zoomBy = factor => {
      this.zoom = Math.max(0.3, Math.min(12, this.zoom * factor));
      this.paintAll();
    };
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      start = fingers.size ? null : event;
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    canvas.addEventListener("pointerup", event => { if (isTap(event)) canvas.classList.toggle("held"); });
    document.addEventListener("pointerdown", event => { if (event.target !== canvas) canvas.classList.remove("held"); });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, event => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", event => {
      if (!fingers.has(event.pointerId)) return;
      const before = fingers.size === 2 ? spread() : 0, last = fingers.get(event.pointerId);
      const turnsOnly = event.pointerType === "touch" && !canvas.classList.contains("held");
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (fingers.size > 1) return zoomBy(before ? spread() / before : 1);
      this.turn += (event.clientX - last.x) * 0.008;
      if (!turnsOnly) this.tilt = between(-Math.PI / 2, this.tilt - (event.clientY - last.y) * 0.008, Math.PI / 2);
      this.paintAll();
    });
    canvas.addEventListener("wheel", event => {
      if (!event.ctrlKey) return;  // the page scrolls
      event.preventDefault();
      zoomBy(Math.exp(-event.deltaY * 0.001));
    }, {passive: false});
    this.listenToKeys();
    new ResizeObserver(() => requestAnimationFrame(() => this.motion && this.paint())).observe(canvas);
  }

  listenToKeys() {
    this.canvas.addEventListener("keydown", event => {
      const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[event.key];
      const zoom = {"+": 1.15, "-": 1 / 1.15}[event.key];
      if (!step && !zoom) return;
      event.preventDefault();
      if (step) { this.turn += step[0]; this.tilt += step[1]; }
      if (zoom) this.zoom *= zoom;
      this.paintAll();
    });
  }

  // A second and a half for one period, while the page shows the canvas.
  play(running) {
    this.running = running;
    let last = null;
    const step = now => {
      if (!this.running) return;
      const box = this.canvas.getBoundingClientRect();
      if (last !== null && box.bottom > 0 && box.top < innerHeight) {
        this.phase += (now - last) / 1500 * 2 * Math.PI;
        this.paintAll();
      }
      last = now;
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
}
