// The sound of the squeal: to be heard, its levels, and where it goes.

const referencePressure = 20e-6;  // Pa
const silence = -20;  // dB: in the plane of a disc the two faces cancel each other, and rounding remains
const levelOf = rms => 20 * Math.log10(Math.max(rms, 1e-30) / referencePressure);
const dB = x => x === null || x === undefined ? "" : x < silence ? "silent" : x.toFixed(1);
const audible = level => level < silence ? NaN : level;

function player({wav, wav_said}) {
  if (!wav_said) return "";
  if (!wav) return note(wav_said);
  return element("figure", {class: "player"}, element("audio", {controls: "", preload: "metadata", src: `data:audio/wav;base64,${wav}`}),
                 element("figcaption", {}, wav_said));
}

function microphonesTable({microphones}) {
  return scrolled(table(["microphone", "position x, y, z, m", "level, dB", "level, dB(A)", "peak level, dB", "level around the axis, dB"],
    microphones.map(({name, position, level_dB, level_A_dB, peak_dB, around}) =>
      [name, position.map(x => formatted(x, 3)).join(`,${unbroken}`), dB(level_dB), dB(level_A_dB), dB(peak_dB),
       [...new Set(around.map(rms => dB(levelOf(rms))))].join(` to${unbroken}`)])), "whole");
}

function tonesTable({tones}) {
  return scrolled(table(["tone, Hz", "radiated power, W", "power level, dB", "error of the pressure by the mesh"],
    tones.map(({frequency_Hz, power, pressure_error}) => [formatted(frequency_Hz, 6), formatted(power), dB(10 * Math.log10(power / 1e-12)),
                                                          pressure_error === null ? "unknown" : percent(pressure_error)])));
}

function feedbackTable({feedback}) {
  const row = (name, brake) => [name, brake.critical_speed === null ? `none: ${brake.stability}` : speedText(brake.critical_speed),
                                formatted(brake.growth), formatted(brake.frequency_Hz, 6), formatted(brake.pad_velocity)];
  return scrolled(table([`at ${speedText(feedback.speed)}`, "squeals from", "growth, 1/s", "limit cycle, Hz", "pad velocity, m/s"],
                        [row("without the damping by sound", feedback.without), row("with it", feedback.with)]), "whole");
}

const markedAs = m => ({colour: m % 6, marker: ["circle", "square", "triangle"][m % 3]});

// The level of each tone at each microphone, as lines from the ground of the picture.
function tonesFigure({tones, microphones}) {
  const levels = microphones.map(({pressure}) => pressure.map(p => audible(levelOf(p / Math.SQRT2))));
  const low = Math.floor(Math.min(0, ...levels.flat().filter(Number.isFinite)) / 10) * 10;
  const x = tones.map(tone => tone.frequency_Hz), highest = tones.map((tone, k) => Math.max(...levels.map(of => of[k]).filter(Number.isFinite)));
  const stems = {colour: 5, width: 1.2, guide: true, x: x.flatMap(f => [f, f, NaN]), y: highest.flatMap(level => [low, level, NaN])};
  const heard = microphones.map(({name}, m) => ({name, ...markedAs(m), line: false, x, y: levels[m]}));
  const series = [stems, ...heard.filter(({y}) => y.some(Number.isFinite))];
  return plot({title: "Tones at the microphones", x: {label: "frequency, Hz", low: 0}, y: {label: "sound pressure level, dB", low}, series});
}

function loudnessFigures({loudness, microphones}) {
  const cases = [["without", "", "none"], ["with", ", damped by its sound", "6 3"]].filter(([key]) => loudness[key].speeds.length);
  const levels = cases.flatMap(([key, more, dash]) => microphones.map(({name}, m) =>
    ({x: loudness[key].speeds, y: loudness[key].levels.map(row => audible(row[m])), name: name + more, dash, ...markedAs(m)})))
    .filter(({y}) => y.some(Number.isFinite));
  const power = cases.map(([key, more, dash], k) =>
    ({x: loudness[key].speeds, y: loudness[key].power, dash, name: `power${more}`, ...markedAs(k)}));
  return [plot({title: "Level over the rotation speed", x: speedAxis, y: {label: "sound pressure level, dB"}, series: levels}),
          plot({title: "Radiated power over the rotation speed", x: speedAxis, y: {label: "power, W", log: true}, series: power})];
}

// The angle, degrees, near 45 at which the name of a ring of radius r covers none of the places `taken`, or as few as can be.
function angleForName(r, cx, cy, taken) {
  const clearance = angle => {
    const x = cx + r * Math.sin(angle * Math.PI / 180), y = cy - r * Math.cos(angle * Math.PI / 180);
    return Math.min(...taken.map(([u, v]) => Math.hypot(Math.max(Math.abs(u - x) - 18, 0), Math.max(Math.abs(v - y) - 5, 0))));
  };
  const angles = Array.from({length: 72}, (_, k) => 45 + (k % 2 ? -5 : 5) * Math.ceil(k / 2)), free = angles.find(angle => clearance(angle) > 4);
  return free ?? angles.reduce((best, angle) => clearance(angle) > clearance(best) ? angle : best);
}

// Levels over an angle that begins at the top and goes clockwise, degrees; rings are 10 dB apart.
function drawPolar(svg, {degrees, levels, from, axes}, width) {
  const sideways = 12 + 6.6 * Math.max(...axes.map(text => text.length)), height = Math.min(400, width - 2 * (sideways - 26));
  const cx = width / 2, cy = height / 2, radius = height / 2 - 26;
  const top = Math.ceil(Math.max(...levels) / 10) * 10, r = level => radius * Math.max(0, level - top + from) / from;
  const rings = Array.from({length: from / 10}, (_, k) => top - from + 10 * (k + 1)), taken = [];
  svg.setAttribute("height", height);
  svg.append(...rings.map(level => svgElement("circle", {cx, cy, r: r(level), class: "grid"})));
  axes.forEach((text, k) => {
    const angle = k * 2 * Math.PI / axes.length, x = Math.sin(angle), y = -Math.cos(angle), anchor = x > 0.5 ? "start" : x < -0.5 ? "end" : "middle";
    for (const away of [-12, 0, 12]) taken.push([cx + (radius + 22) * x + away, cy + (radius + 14) * y]);
    svg.append(svgElement("line", {x1: cx, y1: cy, x2: cx + radius * x, y2: cy + radius * y, class: "grid"}),
               svgElement("text", {x: cx + (radius + 6) * x, y: cy + (radius + 14) * y + 4, "text-anchor": anchor}, text));
  });
  const point = (angle, level) => [cx + r(level) * Math.sin(angle * Math.PI / 180), cy - r(level) * Math.cos(angle * Math.PI / 180)];
  const corners = degrees.map((angle, i) => point(angle, levels[i])), points = corners.map(at => at.map(v => v.toFixed(1)).join(",")).join(" ");
  corners.forEach(([x, y], i) => { const [u, v] = corners.at(i - 1); for (const part of [0, 0.25, 0.5, 0.75]) taken.push([x + part * (u - x), y + part * (v - y)]); });
  svg.append(svgElement("polygon", {points, fill: "none", stroke: "var(--c0)", "stroke-width": 2}));
  for (const level of rings) {
    const [x, y] = point(angleForName(r(level), cx, cy, taken), level);
    svg.append(svgElement("text", {x, y: y + 3.5, "text-anchor": "middle", class: "label halo"}, `${level} dB`));
  }
}

function polarFigure(title, curve) {
  const svg = svgElement("svg", {role: "img", "aria-label": title}), readout = element("p", {class: "readout"});
  const csv = () => [["angle, degrees", "level at 1 m, dB"],
                     ...curve.degrees.map((angle, i) => [formatted(angle, 5), formatted(curve.levels[i], 5)])];
  const files = filesOf(title, (into, width) => drawPolar(into, curve, width), csv);
  const figure = element("figure", {}, svg, element("div", {class: "tools"}, ...files, readout), element("figcaption", {}, title));
  svg.addEventListener("pointermove", event => {
    const box = svg.getBoundingClientRect(), x = event.clientX - box.left - box.width / 2, y = event.clientY - box.top - box.height / 2;
    const angle = (Math.atan2(x, -y) * 180 / Math.PI + 360) % 360, i = nearestIndex(curve.degrees.map(d => (d + 360) % 360), angle);
    readout.textContent = `${formatted(curve.degrees[i])} degrees: ${dB(curve.levels[i])} dB at 1 m`;
  });
  svg.addEventListener("pointerleave", () => { readout.textContent = ""; });
  drawToWidth(figure, width => { svg.replaceChildren(); drawPolar(svg, curve, width); });
  return figure;
}

// Far away, told for 1 m: in the plane of the axis and the loudest direction, and around the axis.
function directivityFigures({directivity: {polar, azimuth, rms}}) {
  const peaks = rms.map(row => Math.max(...row)), i = peaks.indexOf(Math.max(...peaks)), j = rms[i].indexOf(peaks[i]);
  const opposite = nearestIndex(azimuth.map(a => Math.cos(a - azimuth[j])), -1), degrees = angle => angle * 180 / Math.PI;
  const back = [...polar.keys()].reverse().filter(k => polar[k] > 1e-6 && polar[k] < Math.PI - 1e-6);
  const through = {from: 40, axes: ["axis z", "90°", "180°", "90°"], degrees: [...polar.map(degrees), ...back.map(k => 360 - degrees(polar[k]))],
                   levels: [...rms.map(row => levelOf(row[j])), ...back.map(k => levelOf(rms[k][opposite]))]};
  const around = {from: 40, axes: ["0° (x)", "90° (y)", "180°", "270°"], degrees: azimuth.map(degrees), levels: rms[i].map(levelOf)};
  return [polarFigure(`Directivity in a plane through the axis: far-field level referred to 1${unbroken}m, at the azimuth ${formatted(degrees(azimuth[j]), 3)}°`, through),
          polarFigure(`Directivity around the axis: far-field level referred to 1${unbroken}m, ${formatted(degrees(polar[i]), 3)}° from the axis`, around)];
}

function drawSound({sound}) {
  if (sound.left_out) { section("sound", "Sound", note(`Left out: ${sound.left_out}.`)); return; }
  const told = sound.speed === null ? [] : [note(`Limit cycle at ${speedText(sound.speed)}, ${formatted(sound.frequency_Hz, 6)} Hz. ` +
    "Sound pressure levels are those of the effective (RMS) value, relative to 20 µPa; power levels are relative to 1 pW.")];
  const made = [sound.microphones.length && tonesFigure(sound), ...(sound.loudness ? loudnessFigures(sound) : []),
                ...(sound.directivity ? directivityFigures(sound) : [])];
  section("sound", "Sound", ...told, player(sound), ...(sound.microphones.length ? [microphonesTable(sound)] : []),
          ...(sound.tones.length ? [tonesTable(sound)] : []), ...(sound.feedback ? [feedbackTable(sound)] : []), figures(...made),
          ...sound.notes.map(note));
}
