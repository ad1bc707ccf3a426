// What a transient does while the rotation changes: spectrogram, waterfall with orders, strongest lines and their orders.

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

// The number of each order where its line ends in the picture.
function nameOrders(svg, lines, {box, toX, toY}) {
  for (const {x, y, said} of lines) {
    const isInside = ([px, py]) => px > box.left && px < box.left + box.width - 4 && py > box.top + 4;
    const last = x.map((v, i) => [toX(v), toY(y[i])]).filter(isInside).reduce((a, b) => b[1] < a[1] ? b : a, [NaN, Infinity]);
    if (!Number.isFinite(last[0])) continue;
    const place = {x: last[0] - 4, y: Math.max(box.top + 12, last[1] - 3), "text-anchor": "end", class: "label halo"};
    svg.append(svgElement("text", place, said.replace("order ", "")));
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
                  unit: "dB", quantity: "level", z: level_dB, rising: [floor_dB, 0], series, over: nameOrders,
                  title: "Spectrogram of the pad velocity: level relative to the largest amplitude of the run; dashed: orders of the rotation"});
}

// One spectrum behind the other, over the rotation speed where that only rises or only falls, else over the time.
function waterfallFigure(of, orders) {
  const {map_t, frequency_Hz, level_dB, floor_dB} = of, speeds = speedsAt(of), sweeps = isSweep(speeds);
  const places = sweeps ? speeds : map_t, n = places.length, every = Math.max(1, Math.ceil(n / 45));
  const shown = places.map((v, k) => k).filter(k => k % every === 0).sort((a, b) => places[b] - places[a]);  // the last behind
  const high = Math.max(...places), low = Math.min(...places), room = 0.12 * (high - low || 1);
  const y = {...(sweeps ? speedAxis : {label: "time, s"}), low, high: high + room, tight: true};
  const lines = orders.map(order => orderLine(order, places, speeds, false));
  return chart({
    title: `Waterfall: spectra of the pad velocity over the ${sweeps ? "rotation speed" : "time"}, peaks up to ${-floor_dB} dB high; ` +
           "dashed: orders of the rotation",
    height: 420, x: makeAxis({label: "frequency, Hz", tight: true, shown: highestHeard(of)}, frequency_Hz), y: makeAxis(y, places), points: lines,
    csv: () => [["time, s", "speed, rad/s", ...frequency_Hz.map(f => `${f} Hz, dB`)],
                ...map_t.map((at, k) => [at, speeds[k], ...level_dB.map(row => row[k])])],
    paint: (inside, {box, toX, toY}) => {
      const rise = (toY(low) - toY(low + room)) / -floor_dB;
      for (const k of shown) {
        const base = toY(places[k]), top = i => (base - rise * (level_dB[i][k] - floor_dB)).toFixed(1);
        const tops = frequency_Hz.map((f, i) => `${toX(f).toFixed(1)},${top(i)}`);
        inside.append(svgElement("path", {d: `M${tops.join("L")}`, fill: "none", stroke: "var(--c0)", "stroke-width": 1}));
        const ground = `M${toX(frequency_Hz[0])},${base}L${tops.join("L")}L${toX(frequency_Hz.at(-1))},${base}z`;
        inside.insertBefore(svgElement("path", {d: ground, fill: "var(--panel)", stroke: "none"}), inside.lastChild);
      }
      for (const line of lines) drawSeries(inside, line, toX, toY);
      nameOrders(inside, lines, {box, toX, toY});
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

function orderFigures({t, speed, envelope, line_Hz, line_order}) {
  const time = {label: "time, s"}, unknownAsNaN = one => one.map(v => v ?? NaN);
  const lines = values => values.map((one, k) => ({x: t, y: unknownAsNaN(one), colour: k % 6, line: false, marker: "dot",
                                                   name: k ? `no. ${k + 1}` : "strongest line"}))
    .filter(({y}) => y.some(Number.isFinite));
  return [
    plot({title: "Largest pad velocity over the run", x: time, y: {label: "pad velocity, m/s", log: true},
          series: [{x: t, y: envelope, colour: 0}]}),
    plot({title: "Rotation speed", x: time, y: speedAxis, series: [{x: t, y: speed, colour: 1}]}),
    plot({title: "Strongest lines of the spectrum over the time", x: time, y: {label: "frequency, Hz"}, series: lines(line_Hz)}),
    plot({title: "Order tracks: frequency of the strongest lines divided by that of the rotation", x: time,
          y: {label: "order, per revolution"}, series: lines(line_order)})];
}
