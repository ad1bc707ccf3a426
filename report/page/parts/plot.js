// Curves over two axes.

function markerPath(kind, x, y) {
  const r = 4;
  if (kind === "square") return `M${x - r},${y - r}h${2 * r}v${2 * r}h${-2 * r}z`;
  if (kind === "triangle") return `M${x},${y - r}L${x + r},${y + r}H${x - r}z`;
  if (kind === "dot") return `M${x - 2},${y}a2,2 0 1,0 4,0a2,2 0 1,0 -4,0z`;
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
  svg.append(svgElement("path", {d: marks, stroke: colour, "stroke-width": series.marker === "star" ? 2.2 : 1.4,
                                 fill: series.hollow ? "none" : colour}));
}

function drawBand(svg, band, toX, toY) {
  const there = band.x.map((x, i) => `${toX(x).toFixed(1)},${toY(band.high[i]).toFixed(1)}`);
  const back = band.x.map((x, i) => `${toX(x).toFixed(1)},${toY(band.low[i]).toFixed(1)}`).reverse();
  svg.append(svgElement("polygon", {points: [...there, ...back].join(" "), fill: `var(--c${band.colour})`,
                                    opacity: 0.55}));
}

// What leaves the picture at its lower or upper edge is told.
function tellOfClipped(svg, series, {box, toX, toY}) {
  const beyond = far => series.filter(one => one.line !== false && one.y.some((v, i) => far(toY(v)) && toX(one.x[i]) >= box.left)).length;
  const below = beyond(at => at > box.top + box.height + 1), above = beyond(at => at < box.top - 1);
  const tell = (text, y) => svg.append(svgElement("text", {x: box.left + 6, y, class: "halo"}, text));
  if (below) tell(`▾ ${counted(below, "curve")} beyond the lower edge`, box.top + box.height - 6);
  if (above) tell(`▴ ${counted(above, "curve")} beyond the upper edge`, box.top + 14);
}

// The numbers of a plot as rows; a band has two columns.
function csvOfPlot(x, y, series, bands) {
  const edges = bands.flatMap(band => [{x: band.x, y: band.low, name: `${band.name ?? ""} least`.trim()},
                                       {x: band.x, y: band.high, name: `${band.name ?? ""} largest`.trim()}]);
  return csvOfSeries(x, y, [...edges, ...series.filter(one => !one.guide)]);
}

// plot({x, y: axis options, series, bands, choices: {text: axis options, instead of y}}) -> figure. A series with
// `guide` is no result; `said` is its name where it is pointed at.
function plot(options) {
  const series = options.series ?? [], bands = options.bands ?? [];
  const named = [...bands.map(band => ({...band, width: 8})), ...series].filter(entry => entry.name);
  const rows = [...series.flatMap(s => s.y), ...bands.flatMap(b => [...b.low, ...b.high])];
  const choices = Object.entries(options.choices ?? {}).map(([text, other]) => [text, makeAxis(other, rows)]);
  const y = choices.length ? choices[0][1] : makeAxis(options.y, rows);  // the first choice is the one at the beginning
  return chart({
    title: options.title, height: options.height, y, x: makeAxis(options.x, [...series, ...bands].flatMap(s => s.x)),
    choices: Object.fromEntries(choices), legend: named, labelled: series, points: series.filter(one => !one.guide),
    csv: () => csvOfPlot(options.x, y, series, bands),
    paint: (inside, frame) => {
      const {toX, toY} = frame;
      for (const band of bands) drawBand(inside, band, toX, toY);
      for (const one of series) drawSeries(inside, one, toX, toY);
      if (choices.length) tellOfClipped(inside, series, frame);
    }});
}
