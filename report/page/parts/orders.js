// What a transient does while the rotation changes: spectrogram, strongest lines and their orders.

function orderFigures({spectrogram}) {
  const {map_t, t, speed, envelope, frequency_Hz, level_dB, range_dB, line_Hz, line_order} = spectrogram;
  const time = {label: "time, s"};
  const lines = values => values.map((one, k) => ({x: t, y: one.map(v => v ?? NaN), colour: k % 6, line: false, marker: "circle",
                                                   name: k ? `line ${k + 1}` : "strongest line"}));
  return [
    heatMap({x: {label: "time, s", values: map_t}, y: {label: "frequency, Hz", values: frequency_Hz}, z: level_dB, unit: "dB",
             title: `Spectrogram of the pad velocity: dB above the line, which is ${range_dB} dB below the largest amplitude`}),
    plot({title: "Largest pad velocity over the run", x: time, y: {label: "pad velocity, m/s", log: true},
          series: [{x: t, y: envelope, colour: 0}]}),
    plot({title: "Rotation speed", x: time, y: {label: "speed, rad/s"}, series: [{x: t, y: speed, colour: 1}]}),
    plot({title: "Strongest lines over the time", x: time, y: {label: "frequency, Hz"}, series: lines(line_Hz)}),
    plot({title: "Order tracks: frequency of the strongest lines over that of the rotation", x: time,
          y: {label: "order"}, series: lines(line_order)})];
}

// Effects of +1 % of each number, the largest first.
function gradientsTable({gradients}) {
  return scrolled(table(gradients.header, gradients.rows));
}
