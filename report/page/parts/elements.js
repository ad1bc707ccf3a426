// What all sections are made of: elements, numbers for people, files to keep.

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function svgElement(name, attributes = {}, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

function button(text, act, title) {
  const made = element("button", {type: "button", ...(title ? {title, "aria-label": title} : {})}, text);
  made.addEventListener("click", act);
  return made;
}

// A number for people: as many digits as `digits`, powers of ten where they are shorter.
function formatted(x, digits = 4) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e-3 && size < 1e6) return String(Number(x.toPrecision(digits)));
  const [mantissa, exponent] = x.toExponential(Math.max(0, digits - 1)).split("e");
  return `${Number(mantissa)}e${Number(exponent)}`;
}

// "6.23 ± 0.57": two digits of the error, and none of the number behind them; the number alone where its error is not known.
function withError(x, error, digits = 4) {
  if (!Number.isFinite(error)) return formatted(x, digits);
  const leading = size => Math.floor(Math.log10(Math.abs(size)));
  const kept = x === 0 || error === 0 ? digits : leading(x) - leading(error) + 2;
  return `${formatted(x, Math.min(digits, Math.max(1, kept)))} ± ${formatted(error, 2)}`;
}

const rpmOfRadS = 30 / Math.PI;
const unbroken = "\u00a0";  // a space that keeps what it joins on one line
const rpm = speed => `${formatted(speed * rpmOfRadS)}${unbroken}rpm`;
const speedText = (speed, digits = 4) => `${formatted(speed, digits)}${unbroken}rad/s (${rpm(speed)})`;

// Each rotation speed that a text names in rad/s, in rpm beside it.
const withRpm = text => text.replace(/(-?\d[\d.]*(?:e[-+]?\d+)?) rad\/s(?! \()/g, (all, speed) => `${all} (${rpm(Number(speed))})`);

// The colour that a style names, for pixels and for files: `of` tells where the style is in force.
function pageColour(name, of = document.documentElement) {
  const hex = getComputedStyle(of).getPropertyValue(name).trim();
  return [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16));
}

// Gives the reader a file.
function save(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], {type}));
  const link = element("a", {href: address, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

const fileName = title => title.split(/[:;,]/)[0].trim().toLowerCase().replace(/[^a-z0-9]+/g, "_").slice(0, 60);
