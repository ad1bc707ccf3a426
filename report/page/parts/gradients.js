// What to change: the effects of a small change of each number of the brake, as bars and as a table.

const barsShown = 12, barRow = 36;

// Bars from zero, the largest first: orange to the right, blue to the left, the name above each.
function drawBars(svg, bars, width) {
  const room = 62, values = bars.map(({value}) => value), low = Math.min(0, ...values), high = Math.max(0, ...values);
  const left = low < 0 ? room : 8, right = width - (high > 0 ? room : 8), scale = (right - left) / (high - low || 1), zero = left - low * scale;
  svg.setAttribute("height", barRow * bars.length + 8);
  bars.forEach(({name, value, text}, i) => {
    const y = barRow * i + 14, length = Math.max(1, scale * Math.abs(value)), isUp = value > 0, end = zero + (isUp ? length : -length);
    svg.append(svgElement("text", {x: 8, y}, name),
               svgElement("rect", {x: isUp ? zero : end, y: y + 6, width: length, height: 10, fill: `var(--c${isUp ? 1 : 0})`}),
               svgElement("text", {x: end + (isUp ? 5 : -5), y: y + 15, "text-anchor": isUp ? "start" : "end"}, text),
               svgElement("line", {x1: zero, x2: zero, y1: y + 5, y2: y + 17, class: "tick"}));
  });
}

// The bars of one column of the table.
function barsFigure({header, rows}, column) {
  const all = rows.map(row => ({name: row[0], text: row[column], value: Number(row[column])})).filter(({value}) => value)
    .sort((a, b) => Math.abs(b.value) - Math.abs(a.value));
  if (!all.length) return null;
  const bars = all.slice(0, barsShown), what = `Change of the ${header[column]}`;
  const title = `${what}: ${bars.length === all.length ? "all effects" : `the ${bars.length} largest of ${all.length} effects`}`;
  const svg = svgElement("svg", {role: "img", "aria-label": title});
  const files = filesOf(what, (into, width) => drawBars(into, bars, width),
                        () => [[header[0], what], ...all.map(({name, value}) => [name, value])]);
  const figure = element("figure", {class: "bars"}, svg, element("div", {class: "tools"}, ...files), element("figcaption", {}, title));
  drawToWidth(figure, width => { svg.replaceChildren(); drawBars(svg, bars, width); });
  return figure;
}

// Values with their units in one column: the table is less wide.
function gradientsTable({header, rows}) {
  const value = (number, unit) => formatted(Number(number), 6) + (unit === "1" ? "" : `${unbroken}${unit}`);
  return scrolled(table([header[0], "value", ...header.slice(3)], rows.map(([key, number, unit, ...effects]) => [key, value(number, unit), ...effects])), "folded");
}

function drawGradients({gradients}) {
  const effects = gradients.header.map((_, column) => column).slice(3);
  section("gradients", "What to change", note("Each number is raised by itself, by 1 % or by what stands in brackets; " +
            "the changes of the results are computed from derivatives and hold for small steps."),
          figures(...effects.map(column => barsFigure(gradients, column))), gradientsTable(gradients));
}
