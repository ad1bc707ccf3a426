// Values over two axes as colours.

const blended = (stops, part) => {
  const place = Math.max(0, Math.min(1, part)) * (stops.length - 1), k = Math.min(stops.length - 2, Math.floor(place));
  return stops[k].map((c, i) => Math.round(c + (place - k) * (stops[k + 1][i] - c)));
};
const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches;

// From blue over a neutral grey to orange, for values of either sign: told apart with any colour vision.
function divergingColour(value, dark = isDark()) {
  return blended(dark ? [[106, 190, 245], [48, 112, 168], [58, 62, 68], [190, 92, 22], [255, 178, 90]]
                      : [[5, 74, 130], [86, 160, 210], [238, 238, 236], [232, 140, 60], [150, 62, 0]], (value + 1) / 2);
}

// From the ground to a strong colour, for values that have a least one.
function risingColour(part, dark = isDark()) {
  return blended(dark ? [[26, 30, 36], [20, 66, 104], [46, 140, 196], [150, 205, 190], [255, 232, 150]]
                      : [[247, 249, 251], [176, 212, 232], [66, 146, 198], [14, 82, 142], [20, 26, 50]], part);
}

// Roots tell small values of either sign from none: part of [-1, 1] of a value, and back.
function signedScale(z, most) {
  const largest = most ?? (Math.max(...z.flat().map(Math.abs)) || 1);
  return {colour: (value, dark) => divergingColour(Math.sign(value) * Math.sqrt(Math.abs(value) / largest), dark),
          value: part => largest * Math.sign(2 * part - 1) * (2 * part - 1) ** 2, marks: [0, 0.25, 0.5, 0.75, 1]};
}

const risingScale = (low, high) => ({colour: (value, dark) => risingColour((value - low) / (high - low), dark),
                                     value: part => low + part * (high - low), marks: [0, 0.25, 0.5, 0.75, 1]});

// The colours with their values, above the plot; it takes two rows.
function drawColourBar(svg, scale, unit, width, paper) {
  const left = 40, length = width - 80, n = 60;
  for (let k = 0; k < n; ++k) {
    const colour = scale.colour(scale.value((k + 0.5) / n), paper ? false : undefined);
    svg.append(svgElement("rect", {x: left + k * length / n, y: 2, width: length / n + 0.5, height: 9, fill: `rgb(${colour.join(",")})`}));
  }
  for (const part of scale.marks) {
    const value = formatted(scale.value(part), 2), last = part === 1 ? ` ${unit}` : "";
    svg.append(svgElement("text", {x: left + part * length, y: 24, "text-anchor": "middle"}, value + last));
  }
  return 2;
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

// The rows of z as a picture of one pixel each.
function pixelsOf(z, colour) {
  const canvas = element("canvas", {width: z[0].length, height: z.length});
  const painter = canvas.getContext("2d"), image = painter.createImageData(canvas.width, canvas.height);
  z.forEach((row, j) => row.forEach((value, i) =>
    image.data.set([...colour(value), 255], 4 * ((canvas.height - 1 - j) * canvas.width + i))));
  painter.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

const halfStep = values => values.length > 1 ? (values.at(-1) - values[0]) / (values.length - 1) / 2 : 0.5;

const nearestIndex = (values, wanted) => values.reduce((best, v, i) => Math.abs(v - wanted) < Math.abs(values[best] - wanted) ? i : best, 0);

// heatMap({x, y: {label, values}, z: rows over y, unit, quantity, title, height, rising: [low, high], largest}): without `rising`
// orange is positive, as strong as it gets at `largest`, and a line goes along zero.
function heatMap({x, y, z, unit, quantity, title, height = 300, rising, largest, series = [], over, room}) {
  const scale = rising ? risingScale(...rising) : signedScale(z, largest), half = [halfStep(x.values), halfStep(y.values)];
  const axis = (of, margin) => makeAxis({...of, low: of.values[0] - margin, high: of.values.at(-1) + margin, tight: true}, of.values);
  const pixels = {true: null, false: null};
  return chart({
    title, height, room, x: axis(x, half[0]), y: axis(y, half[1]), points: series,
    bar: (svg, width, paper) => drawColourBar(svg, scale, unit, width, paper),
    valueAt: (u, v) => `${quantity} ${formatted(z[nearestIndex(y.values, v)][nearestIndex(x.values, u)])} ${unit}`,
    csv: () => [[`${y.label} \\ ${x.label}`, ...x.values], ...y.values.map((v, j) => [v, ...z[j]])],
    under: (inside, {toX, toY, paper}) => {
      pixels[paper] ??= pixelsOf(z, value => scale.colour(value, paper ? false : undefined));
      const [left, right] = [x.values[0] - half[0], x.values.at(-1) + half[0]].map(toX);
      const [bottom, top] = [y.values[0] - half[1], y.values.at(-1) + half[1]].map(toY);
      inside.append(svgElement("image", {href: pixels[paper], x: left, y: top, width: right - left, height: bottom - top,
                                         preserveAspectRatio: "none", style: "image-rendering: pixelated"}));
    },
    paint: (inside, frame) => {
      const {toX, toY} = frame;
      if (!rising) inside.append(svgElement("path", {d: zeroLine(x.values, y.values, z, toX, toY), stroke: "var(--ink)",
                                                     "stroke-width": 2, fill: "none"}));
      for (const one of series) drawSeries(inside, one, toX, toY);
      if (over) over(inside, series, frame);
    }});
}
