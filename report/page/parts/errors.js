// Size and time against error.

function selectionFigure(selection) {
  const path = (key, colour, marker, name) => ({x: selection[key].map(s => s.size), y: selection[key].map(s => s.error),
                                                colour, marker, name});
  const series = [path("modes_only", 0, "circle", "modes alone"),
                  path("with_interface_modes", 2, "triangle", "with interface modes")].filter(s => s.x.length);
  const sizes = series.flatMap(s => s.x);
  const line = {x: [Math.min(...sizes), Math.max(...sizes)], y: [selection.tolerance, selection.tolerance], colour: 5,
                dash: "5 4", name: "asked for"};
  return plot({title: `Body: largest error of the responses at ${selection.loads.join(", ")} up to ` +
                      `${formatted(selection.up_to_Hz)} Hz; ${selection.chosen} modes were chosen`,
               x: {label: "modes in the body"}, y: {label: "relative error", log: true}, series: [...series, line]});
}

function estimateFigure(modes) {
  const known = key => modes.filter(mode => mode[key] > 0);
  const curve = (key, colour, marker, name) => ({x: known(key).map(m => m.frequency_Hz), y: known(key).map(m => m[key]),
                                                 colour, marker, line: false, name});
  const series = [curve("estimate", 0, "circle", "estimate"), curve("bound", 1, "triangle", "bound")]
    .filter(s => s.x.length);
  return series.length && plot({title: "Reduction: error of each frequency against the FE model",
                                x: {label: "frequency, Hz"}, y: {label: "relative error", log: true}, series});
}

function benchmarkFigure(studies) {
  const markers = ["circle", "square", "triangle"];
  const curve = (study, whose, k, more) => {
    const points = study.tolerances.map(each => each[whose]).filter(point => point);
    return {x: points.map(p => p.cost_s), y: points.map(p => p.error), colour: k % 6, ...more};
  };
  const series = studies.flatMap((study, k) => [
    curve(study, "hand", k, {name: `${study.case}, by hand`, marker: markers[k % 3], hollow: true}),
    curve(study, "chosen", k, {name: `${study.case}, by tolerance`, marker: "star", line: false})]);
  return plot({title: "Whole program: error reached over time spent", x: {label: "CPU time, s", log: true},
               y: {label: "relative error of the frequencies", log: true}, series});
}
