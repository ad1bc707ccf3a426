// What a transient and limit cycles do.

function cycleFigures(content) {
  const {transient, branch} = content, made = [];
  if (transient && transient.envelope.some(v => v > 0))
    made.push(plot({title: `Envelope of the pad velocity at ${speedText(transient.speed)}, ${transient.integrator}`,
                    x: {label: "time, s"}, y: {label: "pad velocity, m/s", log: true},
                    series: [{x: transient.t, y: transient.envelope, colour: 0}]}));
  if (transient) {
    const band = (key, colour, name) => ({x: transient[key].t, low: transient[key].least, high: transient[key].largest, colour, name});
    const {tail} = transient, cycle = chosenCycle(content);
    const first = cycle ? tail.t.findIndex(t => t > tail.t.at(-1) - 6 / cycle.frequency_Hz) : 0;
    const last = values => values.slice(Math.max(0, first));
    made.push(plot({title: "Normal forces of the first pad pair", x: {label: "time, s"}, y: {label: "normal force, N"},
                    bands: [band("N_up", 0, "upper pad"), band("N_lo", 1, "lower pad")]}));
    if (tail.t.length > 1) {
      made.push(plot({title: "Orbit of the upper pad in the last periods", height: 320,
                      x: {label: "pad displacement, mm"}, y: {label: "pad velocity, m/s"},
                      series: [{x: tail.displacement.map(u => 1e3 * u), y: tail.velocity, width: 1, colour: 0}]}));
      made.push(plot({title: "Normal forces in the last periods", x: {label: "time, s"}, y: {label: "normal force, N"},
                      series: [{x: last(tail.t), y: last(tail.N_up), colour: 0, name: "upper pad"},
                               {x: last(tail.t), y: last(tail.N_lo), colour: 1, dash: "6 3", name: "lower pad"}]}));
    }
  }
  if (branch) {
    const {stability} = branch;
    const gap = branch.second_part, speed = withGap(branch.speed, gap);
    const pick = wanted => withGap(branch.pad_velocity.map((v, i) => stability[i] === wanted ? v : NaN), gap);
    const others = [["unstable", "not stable", 1], ["undecided", "stable or not: undecided within the error", 2]]
      .filter(([wanted]) => stability.includes(wanted))
      .map(([wanted, name, colour]) => ({x: speed, y: pick(wanted), colour, dash: "4 4", marker: "circle", hollow: true, name}));
    made.push(plot({title: "Limit cycles over the speed", x: speedAxis, y: {label: "pad velocity, m/s"},
                    series: [{x: speed, y: pick("stable"), colour: 0, marker: "circle", name: "stable"}, ...others]}));
  }
  if (content.spectrum)
    made.push(plot({title: "Spectrum of the pad velocity over the last periods" +
                           (content.limit_cycle?.doubt ? " of a transient that has not settled" : ""),
                    x: {label: "frequency, Hz"}, y: {label: "amplitude, m/s", log: true},
                    series: [{x: content.spectrum.frequency_Hz, y: content.spectrum.amplitude, width: 1.2}]}));
  return made;
}

// No line leads from the part of a curve before the index to the one behind it.
function withGap(values, index) {
  return index == null ? values : [...values.slice(0, index), NaN, ...values.slice(index)];
}

// What a transient has not settled at is no limit cycle where one was found as such.
function chosenCycle({limit_cycle, limit_cycle_direct}) {
  return limit_cycle && !limit_cycle.doubt ? limit_cycle : limit_cycle_direct ?? limit_cycle;
}

// A number of a cycle and what it may be off by.
function known(cycle, name, digits, scale = 1) {
  const error = cycle.errors?.[name] ?? null;
  return withError(scale * cycle[name], error === null ? null : scale * error, digits);
}

function cycleTable(content) {
  const rows = [["limit_cycle", "end of the transient"], ["limit_cycle_direct", "periodic motion, found as such"]]
    .filter(([key]) => content[key]).map(([key, name]) => {
      const cycle = content[key];
      return [name + (cycle.doubt && `, ${cycle.doubt}`), speedText(cycle.speed, 5), known(cycle, "frequency_Hz", 6), known(cycle, "pad_velocity", 5),
              known(cycle, "pad_displacement", 5, 1e3), `${formatted(cycle.N_min, 4)} … ${formatted(cycle.N_max, 4)}`];
    });
  if (!rows.length) return "";
  const what = chosenCycle(content).doubt === "not settled" ? "vibration" : "limit cycle";
  return scrolled(table([what, "rotation speed", "frequency, Hz", "pad velocity, m/s", "pad displacement, mm", "normal force, N"], rows), "folded");
}

// The motion over the last rotations: how large, at which lines, and how it changes as the disc turns.
function drawStatistics({statistics}) {
  const {lines, rms_over_angle} = statistics, n = rms_over_angle.length;
  const figures_of = [["rotation speed", speedText(statistics.speed, 5)],
                      ["effective pad velocity, m/s", formatted(statistics.rms_velocity, 4)],
                      ["largest pad velocity, m/s", formatted(statistics.peak_velocity, 4)],
                      ["largest pad displacement, mm", formatted(1e3 * statistics.peak_displacement, 4)],
                      ["normal force, N", `${formatted(statistics.N_min, 4)} … ${formatted(statistics.N_max, 4)}`],
                      ["modulation by the rotation", percent(statistics.modulation)]];
  const rows = lines.map(line => [formatted(line.frequency_Hz, 6), formatted(line.amplitude, 4), formatted(line.rotations, 4)]);
  section("statistics", `Motion over the last ${statistics.n_rotations} rotations${statistics.doubt && `, ${statistics.doubt}`}`,
    scrolled(table(["quantity", "value"], figures_of)),
    scrolled(table(["line, Hz", "amplitude, m/s", "rotations from the strongest"], rows)),
    figures(plot({title: "Effective pad velocity while the disc turns, mean over the rotations",
                  x: {label: "angle of the disc, degrees"}, y: {label: "pad velocity, m/s", low: 0, high: 1.1 * Math.max(...rms_over_angle)},
                  series: [{x: rms_over_angle.map((_, i) => (i + 0.5) * 360 / n), y: rms_over_angle, colour: 0, marker: "circle"}]})));
}
