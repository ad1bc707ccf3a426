// Frequency responses: amplitude and phase of the outputs for each load, measured ones dashed in the same colour.

// A phase that jumps from -180 to 180 degrees is not joined by a line.
function withoutJumps(x, phase) {
  const made = {x: [], y: []};
  phase.forEach((value, i) => {
    if (i > 0 && Math.abs(value - phase[i - 1]) > 180) { made.x.push(NaN); made.y.push(NaN); }
    made.x.push(x[i]);
    made.y.push(value);
  });
  return made;
}

function responseFigures({frequency_Hz, logarithmic, quantity}, load, curves) {
  const axis = {label: "frequency, Hz", log: Boolean(logarithmic), tight: true};
  const unit = curves[0].unit;
  const style = (curve, k) => ({name: curve.name, colour: k % 6, width: 1.5});
  const styleOfMeasured = (curve, k) => ({name: `${curve.name}, measured`, colour: k % 6, width: 1.2, dash: "5 3"});
  const drawn = of => curves.flatMap((curve, k) => [{...style(curve, k), ...of(curve)},
    ...(curve.measured ? [{...styleOfMeasured(curve, k), ...of(curve.measured)}] : [])]);
  return [plot({title: `Amplitude of the ${quantity} for a unit load at ${load.name}`, x: axis,
                y: {label: `${quantity}, ${unit}`, log: true},
                series: drawn(curve => ({x: frequency_Hz, y: curve.amplitude}))}),
          plot({title: `Phase of the ${quantity} for a unit load at ${load.name}`, x: axis,
                y: {label: "phase, degrees", low: -190, high: 190},
                series: drawn(curve => withoutJumps(frequency_Hz, curve.phase))})];
}

function drawResponses(responses) {
  responses.loads.forEach((load, l) => {
    const made = [], curves = [...load.curves];
    while (curves.length) {  // six of one unit in each figure
      const unit = curves[0].unit, alike = curves.filter(curve => curve.unit === unit).slice(0, 6);
      made.push(...responseFigures(responses, load, alike));
      alike.forEach(curve => curves.splice(curves.indexOf(curve), 1));
    }
    const told = load.left_out ? note(`${load.left_out} smaller outputs are not drawn, to keep this page small; the files have all.`) : "";
    section(`responses-${l + 1}`, `Load at ${load.name}`, figures(...made), told);
  });
}
