// Numbers as people read them.

function significant(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1)
    : value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size))));
  return text.replaceAll('-', '−');
}
const percent = (value, digits = 2) => value === null || !Number.isFinite(value) ? '–' : `${significant(100 * value, digits)}\u00a0%`;
const bouncesText = (count) => `${count} ${count === 1 ? 'bounce' : 'bounces'}`;
const milliseconds = (value) => value === null || value === undefined ? '–' : `${significant(value)}\u00a0ms`;

function bytesText(bytes) {
  if (bytes === null || bytes === undefined) return '–';
  const units = ['B', 'KiB', 'MiB', 'GiB'];
  let unit = 0;
  while (bytes >= 1024 && unit < 3) bytes /= 1024, ++unit;
  return `${unit === 0 ? bytes : significant(bytes, bytes < 10 ? 2 : 3)} ${units[unit]}`;
}

function secondsText(seconds) {
  if (seconds === null || seconds === undefined) return '–';
  if (seconds < 60) return `${significant(seconds, seconds < 10 ? 2 : 3)} s`;
  const whole = Math.round(seconds);
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor(whole % 3600 / 60)} min`;
}

const kLightWords = {
  environment_direct: 'direct light of the environment', environment_indirect: 'bounced light of the environment',
  local_direct: 'direct light of lamps', local_indirect: 'bounced light of lamps',
  emitter_direct: 'direct light of emitters', emitter_indirect: 'bounced light of emitters',
};
const lightWords = (names) => names.map((name) => kLightWords[name] ?? name).join(', ');

/// An element with attributes, listeners (onclick: …) and children; text never becomes markup.
function make(tag, attributes = {}, ...children) {
  const element = tag.startsWith('svg:') ? document.createElementNS('http://www.w3.org/2000/svg', tag.slice(4))
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'style') element.style.cssText = value;
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}
const byId = (id) => document.getElementById(id);

/// Technique i's color: one a technique's name, so that its settings stand together.
const techniqueNames = [...new Set(results.techniques.map((technique) => technique.name))];
const markOf = (technique) => `--mark: var(--c${techniqueNames.indexOf(technique.name) % 8})`;
