// Axes of plots: linear, logarithmic, or logarithmic on both sides of zero.

// Round numbers that divide [low, high] into about `n` parts.
function roundTicks(low, high, n) {
  const raw = (high - low) / n, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= raw * 0.999);
  const ticks = [];
  for (let x = Math.ceil(low / step - 1e-9) * step; x <= high + 1e-9 * step; x += step)
    ticks.push(Math.abs(x) < 1e-9 * step ? 0 : x);
  return ticks;
}

// Powers of ten; of a range with few of them 2 and 5 times these too.
function powerTicks(low, high, n) {
  const ticks = [], first = Math.ceil(Math.log10(low) - 1e-9), last = Math.log10(high) + 1e-9;
  const step = Math.max(1, Math.ceil((last - first) / n));
  for (let k = first; k <= last; k += step) ticks.push(10 ** k);
  if (ticks.length > 2) return ticks;
  const finer = [-1, 0, 1].flatMap(k => [1, 2, 5].map(factor => factor * 10 ** (first + k))).filter(x => low <= x && x <= high);
  return finer.length > 1 ? finer : roundTicks(low, high, 4).filter(x => x > 0);
}

// Zero, and powers of ten on both sides of it, no nearer to each other than 1 / n of the axis.
function signedTicks(axis, n) {
  const ticks = [0], decades = [];
  const largest = Math.max(Math.abs(axis.low), Math.abs(axis.high));
  for (let power = 10 ** Math.floor(Math.log10(largest)); power >= axis.linear / 20; power /= 10) decades.push(power, -power);
  for (const x of decades) {
    if (x < axis.low || x > axis.high || ticks.some(other => Math.abs(axis.at(other) - axis.at(x)) < 1 / n)) continue;
    ticks.push(x);
  }
  const inside = ticks.filter(x => x >= axis.low && x <= axis.high);
  return inside.length > 2 ? inside : roundTicks(axis.low, axis.high, n);
}

// How a scale lays numbers out, and back.
function layout(scale, linear) {
  if (scale === "log") return {image: Math.log, inverse: Math.exp};
  if (scale === "symlog") return {image: x => Math.asinh(x / linear), inverse: u => linear * Math.sinh(u)};
  return {image: x => x, inverse: u => u};
}

// The axis over [low, high]: positions of [0, 1], and values there.
function axisOver(options, low, high) {
  const scale = options.scale ?? (options.log ? "log" : "linear"), {image, inverse} = layout(scale, options.linear);
  const first = image(low), length = image(high) - first;
  const axis = {...options, scale, low, high, at: x => (image(x) - first) / length, value: u => inverse(first + u * length)};
  axis.ticks = n => scale === "log" ? powerTicks(low, high, n) : scale === "symlog" ? signedTicks(axis, n) : roundTicks(low, high, n);
  axis.text = x => scale === "linear" ? formatted(Number(x.toPrecision(12)), 6) : formatted(x, 2);
  // The part [u, v] of it; nothing where doubles or what a scale shows come to an end.
  axis.part = (u, v) => {
    const [from, to] = [axis.value(u), axis.value(v)];
    const shown = Number.isFinite(from) && Number.isFinite(to) && to - from > 1e-9 * Math.max(Math.abs(from), Math.abs(to));
    return shown ? axisOver(options, from, to) : axis;
  };
  return axis;
}

// {label, log or scale, low, high} over values -> an axis with some room at its ends.
function makeAxis(options, values) {
  const isLog = options.log || options.scale === "log";
  const usable = values.filter(x => Number.isFinite(x) && (!isLog || x > 0));
  let low = options.low ?? usable.reduce((a, b) => Math.min(a, b), Infinity);
  let high = options.high ?? usable.reduce((a, b) => Math.max(a, b), -Infinity);
  if (!(low < high)) {
    const width = isLog ? 0 : Math.abs(low) || 1;
    [low, high] = isLog ? [(low || 1) / 2, (high || 1) * 2] : [low - width / 2, high + width / 2];
    if (!Number.isFinite(low)) [low, high] = isLog ? [1, 10] : [0, 1];
  } else if (!options.tight && isLog) {
    [low, high] = [low / 1.3, high * 1.3];
  } else if (!options.tight) {
    const full = axisOver(options, low, high);
    [low, high] = [options.low ?? full.value(-0.04), options.high ?? full.value(1.04)];
  }
  return axisOver(options, low, high);
}

// Where the axis of a growth rate changes from linear to logarithmic: a tenth of the largest growth.
function signedAxis(label, rows) {
  const values = rows.flat().filter(Number.isFinite).map(Math.abs).filter(x => x > 0).sort((a, b) => a - b);
  const largest = rows.flat().filter(Number.isFinite).reduce((a, b) => Math.max(a, b), 0);
  if (!values.length) return {label};
  return {label, scale: "symlog", linear: largest > 1e-6 ? largest / 10 : values[values.length >> 1] / 10};
}
