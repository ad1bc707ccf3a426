// Labels of curves at the right end of a plot.

const labelHeight = 11;

// {text, y, at: none, first} beside the right end of a plot, from top to bottom: those that are `first` are
// moved to where there is room, the others are left out where they have none.
function placed(labels, top, bottom) {
  const taken = [];
  const free = y => y >= top && y <= bottom && taken.every(other => Math.abs(other.at - y) >= labelHeight);
  for (const label of [...labels].sort((a, b) => Boolean(b.first) - Boolean(a.first))) {
    const reach = label.first ? bottom - top : 4;
    for (let away = 0; away <= reach; ++away) {
      const at = [label.y - away, label.y + away].find(free);
      if (at === undefined) continue;
      taken.push({...label, at});
      break;
    }
  }
  return taken;
}

// Labels of the series, each where its curve leaves the plot on the right.
function drawLabels(svg, series, box, toX, toY) {
  const right = box.left + box.width, labels = series.filter(one => one.label).map(one => {
    const last = one.x.findLastIndex((x, i) => Number.isFinite(one.y[i]) && toX(x) <= right + 0.5);
    return {text: one.label, colour: one.colour ?? 0, first: one.first, x: toX(one.x[last]), y: toY(one.y[last])};
  }).filter(label => label.x >= box.left && label.y >= box.top && label.y <= box.top + box.height);
  for (const label of placed(labels, box.top + 4, box.top + box.height))
    svg.append(svgElement("path", {d: `M${label.x},${label.y}L${right},${label.y}L${right + 8},${label.at}`, fill: "none",
                                   stroke: `var(--c${label.colour})`, "stroke-width": 0.6}),
               svgElement("text", {x: right + 10, y: label.at + 3.5, class: "label"}, label.text));
}
