// What a transient does while the rotation changes: spectrogram, waterfall with orders, strongest lines.

// Orders of the rotation in round numbers that lie in the picture at the end of the run.
function roundOrders({speed}, highest_Hz) {
  const fastest = Math.max(...speed) / (2 * Math.PI);
  return fastest > 0 ? roundTicks(0, highest_Hz / fastest, 5).filter(order => order > 0) : [];
}

// Up to where a spectrum of the run is less than the range below the largest amplitude, with some room; all frequencies stay in the files.
function highestHeard({frequency_Hz, level_dB, floor_dB}) {
  const last = level_dB.findLastIndex(row => row.some(level => level > floor_dB));
  return Math.min(frequency_Hz.at(-1), 1.25 * frequency_Hz[Math.max(last, 1)]);
}

// The page has levels above `range_dB` below the largest; told is a level below the largest, down to a floor.
const withLevels = (of, range) => ({...of, floor_dB: -range, level_dB: of.level_dB.map(row => row.map(level => Math.max(-range, level - of.range_dB)))});

// Places where a line of so many events per rotation would be.
function orderLine(order, values, speeds, isUpright) {
  const f = speeds.map(speed => order * speed / (2 * Math.PI));
  return {x: isUpright ? values : f, y: isUpright ? f : values, colour: 1, dash: "5 4", width: 1.1, said: `order ${formatted(order, 5)}`};
}

// Where a line is highest in the picture: a point of it, or where it leaves.
function highestInside(points, {left, top, width}) {
  const right = left + width, isInside = ([x, y]) => x >= left && x <= right + 0.5 && y >= top - 0.5, found = points.filter(isInside);
  const between = (a, b, part) => [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];
  for (let i = 0; i + 1 < points.length; ++i) {
    const [a, b] = [points[i], points[i + 1]];
    if (isInside(a) === isInside(b)) continue;
    found.push(...[between(a, b, (top - a[1]) / (b[1] - a[1])), between(a, b, (right - a[0]) / (b[0] - a[0]))]
      .filter(at => isInside(at) && Math.min(a[1], b[1]) <= at[1] + 0.5 && at[1] <= Math.max(a[1], b[1]) + 0.5));
  }
  return found.reduce((a, b) => b[1] < a[1] ? b : a, [NaN, Infinity]);
}

// The number of each order where its line ends in the picture: outside of the frame where there is room, so that it covers nothing.
function nameOrders(inside, lines, {svg, box, toX, toY}, hasRoom) {
  const right = box.left + box.width;
  for (const {x, y, said} of lines) {
    const name = said.replace("order ", ""), [px, py] = highestInside(x.map((v, i) => [toX(v), toY(y[i])]), box);
    if (!Number.isFinite(px)) continue;
    const outside = py < box.top + 2 ? {x: px, y: box.top - 3, "text-anchor": "middle"} : px > right - 8 && hasRoom ? {x: right + 4, y: py + 3.5} : null;
    const within = {x: Math.max(Math.min(px, right) - 4, box.left + 4 + 6.4 * name.length), y: Math.max(box.top + 12, py - 3), "text-anchor": "end"};
    (outside ? svg : inside).append(svgElement("text", {...outside ?? within, class: "label halo"}, name));
  }
}

const speedsAt = ({map_t, t, speed}) => map_t.map(at => speed[nearestIndex(t, at)]);

// Whether the rotation becomes ever faster, or ever slower, so that it can be the axis of a run.
function isSweep(speeds) {
  const step = (speeds.at(-1) - speeds[0]) / (speeds.length - 1), largest = Math.max(...speeds.map(Math.abs));
  return Math.abs(step) * speeds.length > 0.05 * largest && speeds.every((v, i) => i === 0 || (v - speeds[i - 1]) * step > 0);
}

function spectrogramFigure(of, orders) {
  const {map_t, frequency_Hz, level_dB, floor_dB} = of, speeds = speedsAt(of);
  const series = orders.map(order => orderLine(order, map_t, speeds, true));
  return heatMap({x: {label: "time, s", values: map_t}, y: {label: "frequency, Hz", values: frequency_Hz, shown: highestHeard(of)},
                  unit: "dB", quantity: "level", z: level_dB, rising: [floor_dB, 0], series, height: 384,
                  room: Math.max(0, ...series.map(({said}) => said.length - "order ".length)), over: (inside, lines, frame) => nameOrders(inside, lines, frame, true),
                  title: "Spectrogram of the pad velocity: level relative to the largest amplitude of the run; dashed: orders of the rotation"});
}

// One spectrum behind the other, over the rotation speed where that only rises or only falls, else over the time.
function waterfallFigure(of, orders) {
  const {map_t, frequency_Hz, level_dB, floor_dB} = of, speeds = speedsAt(of), sweeps = isSweep(speeds);
  const places = sweeps ? speeds : map_t, n = places.length, every = Math.max(1, Math.ceil(n / 45));
  const shown = places.map((v, k) => k).filter(k => k % every === 0).sort((a, b) => places[b] - places[a]);  // the last behind
  const high = Math.max(...places), low = Math.min(...places), room = 0.12 * (high - low || 1);
  const y = {...(sweeps ? speedAxis : {label: "time, s"}), low, high: high + room, tight: true};
  const upwards = [...places].sort((a, b) => a - b).concat(y.high);  // of a run over the speed, orders go on above the last spectrum
  const lines = orders.map(order => sweeps ? orderLine(order, upwards, upwards, false) : orderLine(order, places, speeds, false));
  return chart({
    title: `Waterfall: spectra of the pad velocity over the ${sweeps ? "rotation speed" : "time"}, peaks up to ${-floor_dB} dB high; ` +
           "dashed: orders of the rotation",
    height: 420, x: makeAxis({label: "frequency, Hz", tight: true, shown: highestHeard(of)}, frequency_Hz), y: makeAxis(y, places), points: lines,
    csv: () => [["time, s", "speed, rad/s", ...frequency_Hz.map(f => `${f} Hz, dB`)],
                ...map_t.map((at, k) => [at, speeds[k], ...level_dB.map(row => row[k])])],
    paint: (inside, frame) => {
      const {toX, toY} = frame;
      const rise = (toY(low) - toY(low + room)) / -floor_dB;
      for (const k of shown) {
        const base = toY(places[k]), top = i => (base - rise * (level_dB[i][k] - floor_dB)).toFixed(1);
        const tops = frequency_Hz.map((f, i) => `${toX(f).toFixed(1)},${top(i)}`);
        inside.append(svgElement("path", {d: `M${tops.join("L")}`, fill: "none", stroke: "var(--c0)", "stroke-width": 1}));
        const ground = `M${toX(frequency_Hz[0])},${base}L${tops.join("L")}L${toX(frequency_Hz.at(-1))},${base}z`;
        inside.insertBefore(svgElement("path", {d: ground, fill: "var(--panel)", stroke: "none"}), inside.lastChild);
      }
      for (const line of lines) drawSeries(inside, line, toX, toY);
      nameOrders(inside, lines, frame, false);
    }});
}

// Spectrogram and waterfall, with the orders and the range of levels that the reader asks for.
function orderPictures(of) {
  const made = element("div", {class: "figures"}), input = element("input", {type: "text", size: 24, "aria-label": "orders"});
  const range = element("select", {}, ...[40, 60, 80, 100].map(dB => element("option", {value: dB}, `${dB} dB`)));
  const draw = () => {
    const orders = input.value.split(/[,; ]+/).map(Number).filter(order => order > 0), told = withLevels(of, Number(range.value));
    made.replaceChildren(spectrogramFigure(told, orders), waterfallFigure(told, orders));
  };
  range.value = of.range_dB;
  input.value = roundOrders(of, highestHeard(withLevels(of, of.range_dB))).map(order => formatted(order, 5)).join(", ");
  for (const control of [input, range]) control.addEventListener("change", draw);
  draw();
  return [element("div", {class: "controls"}, element("label", {}, "orders, per revolution: ", input),
                  element("label", {}, "range of the levels ", range)), made];
}

// The strongest line of each window is a square; weaker ones are dots.
function lineSeries(t, line_Hz) {
  return line_Hz.map((row, rank) => ({x: t, y: row.map(f_Hz => f_Hz ?? NaN), line: false, colour: rank === 0 ? 5 : 0, marker: rank === 0 ? "square" : "dot",
                                      name: ["strongest line", "weaker lines"][rank] ?? ""}))
    .filter(({y}) => y.some(Number.isFinite));
}

function orderFigures({t, speed, envelope, line_Hz}) {
  const time = {label: "time, s"};
  return [
    plot({title: "Largest pad velocity over the run", x: time, y: {label: "pad velocity, m/s", log: true},
          series: [{x: t, y: envelope, colour: 0}]}),
    plot({title: "Rotation speed", x: time, y: speedAxis, series: [{x: t, y: speed, colour: 1}]}),
    plot({title: "Strongest lines of the spectrum over the time", x: time, y: {label: "frequency, Hz"}, series: lineSeries(t, line_Hz)})];
}
