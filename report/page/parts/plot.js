// Curves and maps as SVG that fills the width it is given.

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function svgElement(name, attributes = {}, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// A number for people: as many digits as `digits`, powers of ten where they are shorter.
function formatted(x, digits = 4) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e-3 && size < 1e6) return String(Number(x.toPrecision(digits)));
  const [mantissa, exponent] = x.toExponential(Math.max(0, digits - 1)).split("e");
  return `${Number(mantissa)}e${Number(exponent)}`;
}

// Round numbers that divide [low, high] into about `n` parts.
function roundTicks(low, high, n) {
  const raw = (high - low) / n, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= raw * 0.999);
  const ticks = [];
  for (let x = Math.ceil(low / step - 1e-9) * step; x <= high + 1e-9 * step; x += step)
    ticks.push(Math.abs(x) < 1e-9 * step ? 0 : x);
  return ticks;
}

function powerTicks(low, high) {
  const ticks = [], first = Math.ceil(Math.log10(low) - 1e-9), last = Math.log10(high) + 1e-9;
  const step = Math.max(1, Math.ceil((last - first) / 7));
  for (let k = first; k <= last; k += step) ticks.push(10 ** k);
  return ticks.length > 1 ? ticks : roundTicks(low, high, 4).filter(x => x > 0);
}

// {label, log, low, high} over values -> positions of [0, 1], ticks and texts.
function makeAxis(options, values) {
  const usable = values.filter(x => Number.isFinite(x) && (!options.log || x > 0));
  let low = options.low ?? usable.reduce((a, b) => Math.min(a, b), Infinity);
  let high = options.high ?? usable.reduce((a, b) => Math.max(a, b), -Infinity);
  if (!(low < high)) {
    const width = options.log ? 0 : Math.abs(low) || 1;
    [low, high] = options.log ? [(low || 1) / 2, (high || 1) * 2] : [low - width / 2, high + width / 2];
    if (!Number.isFinite(low)) [low, high] = options.log ? [1, 10] : [0, 1];
  } else if (!options.tight && options.log) {
    [low, high] = [low / 1.3, high * 1.3];
  } else if (!options.tight) {
    const margin = 0.04 * (high - low);
    low = options.low ?? low - margin;
    high = options.high ?? high + margin;
  }
  const image = options.log ? Math.log : x => x;
  return {
    low, high, label: options.label,
    ticks: options.log ? powerTicks(low, high) : roundTicks(low, high, 6),
    at: x => (image(x) - image(low)) / (image(high) - image(low)),
    text: x => options.log ? formatted(x, 2) : formatted(Number(x.toPrecision(12)), 5),
  };
}

// Draws into `figure` again whenever its width changes.
function drawToWidth(figure, draw) {
  let width = 0;
  const redraw = () => {
    const now = Math.max(280, Math.round(figure.clientWidth - 20));
    if (Math.abs(now - width) < 2) return;
    width = now;
    figure.querySelector("svg")?.remove();
    figure.prepend(draw(width));
  };
  redraw();
  new ResizeObserver(() => requestAnimationFrame(redraw)).observe(figure);
}

function drawAxes(svg, box, x, y) {
  const {left, top, width, height} = box;
  for (const tick of x.ticks) {
    const at = left + width * x.at(tick);
    svg.append(svgElement("line", {x1: at, x2: at, y1: top, y2: top + height, class: "grid"}),
               svgElement("text", {x: at, y: top + height + 16, "text-anchor": "middle"}, x.text(tick)));
  }
  for (const tick of y.ticks) {
    const at = top + height * (1 - y.at(tick));
    svg.append(svgElement("line", {x1: left, x2: left + width, y1: at, y2: at, class: "grid"}),
               svgElement("text", {x: left - 6, y: at + 4, "text-anchor": "end"}, y.text(tick)));
  }
  svg.append(svgElement("rect", {x: left, y: top, width, height, class: "frame"}),
             svgElement("text", {x: left + width / 2, y: top + height + 34, "text-anchor": "middle"}, x.label),
             svgElement("text", {transform: `translate(14 ${top + height / 2}) rotate(-90)`,
                                 "text-anchor": "middle"}, y.label));
}

function markerPath(kind, x, y) {
  const r = 4;
  if (kind === "square") return `M${x - r},${y - r}h${2 * r}v${2 * r}h${-2 * r}z`;
  if (kind === "triangle") return `M${x},${y - r}L${x + r},${y + r}H${x - r}z`;
  if (kind === "star") return `M${x - 7},${y}H${x + 7}M${x},${y - 7}V${y + 7}M${x - 5},${y - 5}l10,10M${x - 5},${y + 5}l10,-10`;
  return `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0z`;
}

function drawSeries(svg, series, toX, toY) {
  const colour = `var(--c${series.colour ?? 0})`;
  const points = series.x.map((x, i) => [toX(x), toY(series.y[i])]);
  const usable = points.map(p => p.every(Number.isFinite));
  let path = "";
  points.forEach((p, i) => {
    if (usable[i]) path += `${i > 0 && usable[i - 1] ? "L" : "M"}${p[0].toFixed(1)},${p[1].toFixed(1)}`;
  });
  if (series.line !== false)
    svg.append(svgElement("path", {d: path, fill: "none", stroke: colour, "stroke-width": series.width ?? 1.8,
                                   "stroke-dasharray": series.dash ?? "none", "stroke-linejoin": "round"}));
  if (!series.marker) return;
  const marks = points.filter((p, i) => usable[i]).map(p => markerPath(series.marker, ...p)).join("");
  svg.append(svgElement("path", {d: marks, stroke: colour, "stroke-width": series.marker === "star" ? 2.2 : 1,
                                 fill: series.hollow ? "none" : colour}));
}

function drawBand(svg, band, toX, toY) {
  const there = band.x.map((x, i) => `${toX(x).toFixed(1)},${toY(band.high[i]).toFixed(1)}`);
  const back = band.x.map((x, i) => `${toX(x).toFixed(1)},${toY(band.low[i]).toFixed(1)}`).reverse();
  svg.append(svgElement("polygon", {points: [...there, ...back].join(" "), fill: `var(--c${band.colour})`,
                                    opacity: 0.55}));
}

function drawLegend(svg, entries, left, top, width) {
  let x = left, y = top;
  for (const entry of entries) {
    const needed = 30 + 7 * entry.name.length;
    if (x + needed > left + width && x > left) { x = left; y += 18; }
    drawSeries(svg, {...entry, x: entry.marker && entry.line === false ? [x + 10] : [x, x + 20],
                     y: entry.marker && entry.line === false ? [y - 4] : [y - 4, y - 4],
                     marker: entry.line === false ? entry.marker : undefined}, v => v, v => v);
    svg.append(svgElement("text", {x: x + 25, y}, entry.name));
    x += needed + 10;
  }
  return y - top;
}

// Where the pointer is, in the units of the axes.
function addReadout(svg, box, x, y) {
  const text = svgElement("text", {class: "readout", "text-anchor": "end", x: box.left + box.width - 6,
                                   y: box.top + 16});
  svg.append(text);
  const value = (axis, part, log) => log ? axis.low * (axis.high / axis.low) ** part
                                         : axis.low + part * (axis.high - axis.low);
  svg.addEventListener("pointermove", event => {
    const place = svg.getBoundingClientRect();
    const u = (event.clientX - place.left - box.left) / box.width;
    const v = 1 - (event.clientY - place.top - box.top) / box.height;
    const inside = u >= 0 && u <= 1 && v >= 0 && v <= 1;
    text.textContent = inside ? `${formatted(value(x.axis, u, x.log))}, ${formatted(value(y.axis, v, y.log))}` : "";
  });
  svg.addEventListener("pointerleave", () => { text.textContent = ""; });
}

// plot({x, y: axis options, series, bands}) -> figure
function plot(options) {
  const figure = element("figure");
  const series = options.series ?? [], bands = options.bands ?? [];
  const named = [...bands.map(band => ({...band, width: 8})), ...series].filter(entry => entry.name);
  const xAxis = makeAxis(options.x, [...series, ...bands].flatMap(s => s.x));
  const yAxis = makeAxis(options.y, [...series.flatMap(s => s.y), ...bands.flatMap(b => [...b.low, ...b.high])]);
  drawToWidth(figure, width => {
    const svg = svgElement("svg", {role: "img", "aria-label": options.title});
    const rows = drawLegend(svg, named, 70, 14, width - 80);
    const right = series.some(one => one.label) ? 62 : 14;
    const box = {left: 70, top: named.length ? 26 + rows : 10, width: width - 70 - right,
                 height: options.height ?? 260};
    svg.setAttribute("height", box.top + box.height + 42);
    const clip = `clip${clipCount++}`;
    const inside = svgElement("g", {"clip-path": `url(#${clip})`});
    const definition = svgElement("clipPath", {id: clip});
    definition.append(svgElement("rect", {x: box.left, y: box.top, width: box.width, height: box.height}));
    const toX = x => box.left + box.width * xAxis.at(x);
    const toY = y => box.top + box.height * (1 - yAxis.at(y));
    drawAxes(svg, box, xAxis, yAxis);
    for (const band of bands) drawBand(inside, band, toX, toY);
    for (const one of series) drawSeries(inside, one, toX, toY);
    svg.append(definition, inside);
    drawLabels(svg, series, box, toX, toY);
    addReadout(svg, box, {axis: xAxis, log: options.x.log}, {axis: yAxis, log: options.y.log});
    return svg;
  });
  figure.append(element("figcaption", {}, options.title));
  return figure;
}
let clipCount = 0;

// From blue over a neutral grey to orange, for values of either sign: told apart with any colour vision.
function divergingColour(value) {
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const stops = dark ? [[106, 190, 245], [48, 112, 168], [58, 62, 68], [190, 92, 22], [255, 178, 90]]
                     : [[5, 74, 130], [86, 160, 210], [238, 238, 236], [232, 140, 60], [150, 62, 0]];
  const place = (Math.max(-1, Math.min(1, value)) + 1) * 2, k = Math.min(3, Math.floor(place));
  return stops[k].map((c, i) => Math.round(c + (place - k) * (stops[k + 1][i] - c)));
}

// heatMap({x, y: {label, values}, z: rows over y, unit, title}): orange is positive, and a line
// goes along zero.
function heatMap({x, y, z, unit, title, series = []}) {
  const figure = element("figure");
  const largest = Math.max(...z.flat().map(Math.abs)) || 1;
  // Roots tell small growth rates from none.
  const scaled = value => Math.sign(value) * Math.sqrt(Math.abs(value) / largest);
  const canvas = element("canvas", {width: x.values.length, height: y.values.length});
  const painter = canvas.getContext("2d"), image = painter.createImageData(canvas.width, canvas.height);
  z.forEach((row, j) => row.forEach((value, i) => {
    const at = 4 * ((canvas.height - 1 - j) * canvas.width + i);
    image.data.set([...divergingColour(scaled(value)), 255], at);
  }));
  painter.putImageData(image, 0, 0);
  const half = values => values.length > 1 ? (values.at(-1) - values[0]) / (values.length - 1) / 2 : 0.5;
  const axis = ({label, values}) => makeAxis({label, low: values[0] - half(values), high: values.at(-1) + half(values),
                                              tight: true}, values);
  const xAxis = axis(x), yAxis = axis(y);
  drawToWidth(figure, width => {
    const svg = svgElement("svg", {role: "img", "aria-label": title});
    const box = {left: 70, top: 10, width: width - 84, height: 280};
    svg.setAttribute("height", box.top + box.height + 42);
    svg.append(svgElement("image", {href: canvas.toDataURL(), x: box.left, y: box.top, width: box.width,
                                    height: box.height, preserveAspectRatio: "none",
                                    style: "image-rendering: pixelated"}));
    drawAxes(svg, box, xAxis, yAxis);
    const toX = v => box.left + box.width * xAxis.at(v), toY = v => box.top + box.height * (1 - yAxis.at(v));
    svg.append(svgElement("path", {d: zeroLine(x.values, y.values, z, toX, toY), stroke: "var(--ink)",
                                   "stroke-width": 2, fill: "none"}));
    for (const one of series) drawSeries(svg, one, toX, toY);
    addReadout(svg, box, {axis: xAxis}, {axis: yAxis});
    return svg;
  });
  figure.append(colourBar(largest, unit), element("figcaption", {}, title));
  return figure;
}

function colourBar(largest, unit) {
  const bar = element("div", {class: "bar"});
  const stops = Array.from({length: 21}, (_, k) => `rgb(${divergingColour(k / 10 - 1)})`);
  bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
  const scale = element("div", {class: "scale"}, element("span", {}, `${formatted(-largest, 3)} ${unit}`),
                        element("span", {}, "0"), element("span", {}, `${formatted(largest, 3)} ${unit}`));
  return element("div", {}, bar, scale);
}

// Segments along z = 0 by linear interpolation on the triangles of each square.
function zeroLine(xs, ys, z, toX, toY) {
  let path = "";
  const crossing = (a, b) => {
    const part = a[2] / (a[2] - b[2]);
    return [toX(a[0] + part * (b[0] - a[0])), toY(a[1] + part * (b[1] - a[1]))];
  };
  for (let j = 0; j + 1 < ys.length; ++j) {
    for (let i = 0; i + 1 < xs.length; ++i) {
      const corner = (k, l) => [xs[i + k], ys[j + l], z[j + l][i + k]];
      for (const triangle of [[corner(0, 0), corner(1, 0), corner(0, 1)], [corner(1, 1), corner(1, 0), corner(0, 1)]]) {
        const ends = [[0, 1], [1, 2], [2, 0]].filter(([a, b]) => triangle[a][2] > 0 !== triangle[b][2] > 0)
          .map(([a, b]) => crossing(triangle[a], triangle[b]));
        if (ends.length === 2) path += `M${ends[0].map(v => v.toFixed(1))}L${ends[1].map(v => v.toFixed(1))}`;
      }
    }
  }
  return path;
}
