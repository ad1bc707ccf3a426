// A figure with two axes as SVG that fills the width it is given: what curves, maps and waterfalls share.

let clipCount = 0;
const between = (low, n, high) => Math.max(low, Math.min(high, n));

// Room around the plot: for the legend above, the numbers of the axes, and names of curves on the right, which have at most `room` letters.
function boxOf(options, {x, y}, width, rows) {
  const height = options.height ?? 260, longest = Math.max(...y.ticks(height / 40).map(tick => y.text(tick).length));
  const named = Math.max(options.room ?? 0, ...(options.labelled ?? []).map(one => (one.label ?? "").length));
  const left = 32 + 7 * longest, right = y.second ? 58 : named ? 14 + 6 * named : 14;
  const top = (rows ? 10 + 18 * rows : 10) + (x.second ? 20 : 0);
  return {left, top, width: width - left - right, height};
}

function drawXAxis(svg, {left, top, width, height}, x) {
  for (const tick of x.ticks(between(2, Math.floor(width / 55), 14))) {
    const at = left + width * x.at(tick);
    svg.append(svgElement("line", {x1: at, x2: at, y1: top, y2: top + height, class: "grid"}),
               svgElement("text", {x: at, y: top + height + 16, "text-anchor": "middle"}, x.text(tick)));
  }
  svg.append(svgElement("text", {x: left + width / 2, y: top + height + 34, "text-anchor": "middle"}, x.label));
  if (!x.second) return;
  const {factor, unit} = x.second;
  for (const tick of roundTicks(x.low * factor, x.high * factor, between(2, Math.floor(width / 55), 14))) {
    const at = left + width * x.at(tick / factor);
    svg.append(svgElement("line", {x1: at, x2: at, y1: top - 4, y2: top, class: "tick"}),
               svgElement("text", {x: at, y: top - 11, "text-anchor": "middle"}, formatted(tick, 6)));
  }
  svg.append(svgElement("text", {x: left - 8, y: top - 11, "text-anchor": "end"}, unit));
}

function drawYAxis(svg, {left, top, width, height}, y) {
  for (const tick of y.ticks(Math.max(2, Math.floor(height / 40)))) {
    const at = top + height * (1 - y.at(tick));
    svg.append(svgElement("line", {x1: left, x2: left + width, y1: at, y2: at, class: tick === 0 && y.low < 0 ? "zero" : "grid"}),
               svgElement("text", {x: left - 6, y: at + 4, "text-anchor": "end"}, y.text(tick)));
  }
  svg.append(svgElement("text", {transform: `translate(13 ${top + height / 2}) rotate(-90)`, "text-anchor": "middle"}, y.label));
  if (!y.second) return;
  const {factor, unit} = y.second, right = left + width;
  for (const tick of roundTicks(y.low * factor, y.high * factor, Math.max(2, Math.floor(height / 40)))) {
    const at = top + height * (1 - y.at(tick / factor));
    svg.append(svgElement("line", {x1: right, x2: right + 4, y1: at, y2: at, class: "tick"}),
               svgElement("text", {x: right + 7, y: at + 4}, formatted(tick, 6)));
  }
  svg.append(svgElement("text", {transform: `translate(${right + 52} ${top + height / 2}) rotate(-90)`, "text-anchor": "middle"}, unit));
}

// A text in lines of at most so many letters; a longer word has a line of its own.
function wrapped(text, most) {
  const lines = [""];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`.trim();
    if (longer.length <= most || !lines.at(-1)) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

function drawLegend(svg, entries, left, top, width) {
  const letter = 6.6;
  let x = left, rows = entries.length ? 1 : 0;
  for (const entry of entries) {
    const lines = wrapped(entry.name, Math.floor((width - 30) / letter)), alone = entry.marker && entry.line === false;
    const needed = 30 + letter * Math.max(...lines.map(line => line.length));
    if (x > left && (lines.length > 1 || x + needed > left + width)) { x = left; ++rows; }
    const y = top + 18 * (rows - 1);
    drawSeries(svg, {...entry, x: alone ? [x + 10] : [x, x + 20], y: alone ? [y - 4] : [y - 4, y - 4],
                     marker: alone ? entry.marker : undefined}, v => v, v => v);
    lines.forEach((line, k) => svg.append(svgElement("text", {x: x + 25, y: y + 18 * k}, line)));
    rows += lines.length - 1;
    x += needed + 10;
  }
  return rows;
}

// Fills `svg` and returns where things are in it. `paper`: for a file, in the colours of a light page.
function drawChart(svg, options, state, width, paper = false) {
  const {x, y} = state, head = svgElement("g");
  const rows = options.bar ? options.bar(head, width, paper) : drawLegend(head, options.legend ?? [], 14, 14, width - 20);
  const box = boxOf(options, state, width, rows), clip = `clip${clipCount++}`;
  const frame = {svg, box, paper, toX: v => box.left + box.width * x.at(v), toY: v => box.top + box.height * (1 - y.at(v))};
  svg.setAttribute("height", box.top + box.height + 42);
  const definition = svgElement("clipPath", {id: clip}), inside = svgElement("g", {"clip-path": `url(#${clip})`});
  definition.append(svgElement("rect", {x: box.left, y: box.top, width: box.width, height: box.height}));
  svg.replaceChildren(definition, head);
  if (options.under) options.under(inside, frame, state);
  drawXAxis(svg, box, x);
  drawYAxis(svg, box, y);
  if (options.under) svg.insertBefore(inside, svg.children[2]);
  const over = options.under ? svgElement("g", {"clip-path": `url(#${clip})`}) : inside;
  options.paint(over, frame, state);
  svg.append(over, svgElement("rect", {x: box.left, y: box.top, width: box.width, height: box.height, class: "frame"}));
  drawLabels(svg, options.labelled ?? [], box, frame.toX, frame.toY);
  return frame;
}

// Draws again whenever the width changes.
function drawToWidth(figure, draw) {
  let width = 0;
  const redraw = () => {
    const now = Math.max(260, Math.round(figure.clientWidth - (innerWidth < 600 ? 8 : 20)));
    if (Math.abs(now - width) < 2) return;
    width = now;
    draw(width);
  };
  redraw();
  new ResizeObserver(() => requestAnimationFrame(redraw)).observe(figure);
}

// The axis up to its `shown`, which the picture begins with: "whole" goes on to the end.
const asShown = axis => axis.shown < axis.high ? axis.part(0, axis.at(axis.shown)) : axis;

// chart({title, x, y: axes, paint, legend, labelled, points, valueAt, csv, choices}) -> figure
function chart(options) {
  const svg = svgElement("svg", {role: "img", "aria-label": options.title, tabindex: "0"});
  const readout = element("p", {class: "readout"}), figure = element("figure", {}, svg);
  const shown = {options, svg, readout, state: {x: asShown(options.x), y: asShown(options.y)}};
  shown.redraw = () => { shown.frame = drawChart(svg, options, shown.state, shown.width); };
  shown.show = (x, y) => { Object.assign(shown.state, {x, y}); svg.classList.toggle("closer", x !== options.x || y !== options.y); shown.redraw(); };
  shown.whole = () => shown.show(options.x, options.y);
  figure.append(element("div", {class: "tools"}, ...toolsOf(shown), readout), element("figcaption", {}, options.title));
  drawToWidth(figure, width => { shown.width = width; shown.redraw(); });
  lookCloser(shown);
  return figure;
}
