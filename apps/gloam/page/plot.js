// Error against time: a point a technique, points of one technique joined in the order of time.

const plotMeasures = [
  ['relative_error', 'Relative error ‖a−b‖ / ‖b‖', (m) => m.relative_squared_error === null ? null : Math.sqrt(m.relative_squared_error), (v) => percent(v)],
  ['flip', 'FLIP', (m) => m.flip, (v) => significant(v)],
  ['rmse', 'RMSE', (m) => m.rmse, (v) => significant(v)],
];
const kPlot = {width: 880, height: 400, left: 68, right: 30, top: 20, bottom: 52};

/// A scale from data to pixels with round ticks: logarithmic where the values span more than a factor of eight.
function axis(values, from, to, format) {
  let low = Math.min(...values), high = Math.max(...values);
  const log = low > 0 && high / low > 8;
  if (log) low /= 1.6, high *= 1.6;
  else low = 0, high = high > 0 ? high * 1.25 : 1;
  const at = (v) => log ? from + (to - from) * Math.log(v / low) / Math.log(high / low) : from + (to - from) * (v - low) / (high - low);
  const ticks = [];
  if (log) {
    for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); ++decade) {
      for (const digit of [1, 2, 5]) ticks.push(digit * 10 ** decade);
    }
  } else {
    const rough = (high - low) / 5, power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((digit) => digit * power >= rough);
    for (let k = 0; k * step <= high * 1.0001; ++k) ticks.push(k * step);
  }
  return {at, log, ticks: ticks.filter((tick) => tick >= low * 0.9999 && tick <= high * 1.0001), format};
}

function buildPlot() {
  byId('plot-measure').append(...plotMeasures.map(([key, name]) => make('option', {value: key}, name)));
  byId('plot-measure').addEventListener('change', updatePlot);
}

function updatePlot() {
  const [, name, value, format] = plotMeasures.find(([key]) => key === byId('plot-measure').value) ?? plotMeasures[0];
  const points = results.techniques.map((technique, index) => ({technique, index, x: technique.device_ms, y: value(measuresOf(technique, state.layer))}))
    .filter(({x, y}) => x !== null && y !== null && Number.isFinite(x) && Number.isFinite(y));
  const holder = byId('plot');
  holder.replaceChildren();
  byId('plot-caption').textContent = '';
  if (points.length === 0) { byId('plot-caption').textContent = 'Nothing to plot for this light.'; return; }
  const narrow = holder.clientWidth < 560;
  const size = narrow ? {...kPlot, width: 400, height: 340, left: 58, right: 14} : kPlot;
  const x = axis(points.map((p) => p.x), size.left, size.width - size.right, significant);
  const y = axis(points.map((p) => p.y), size.height - size.bottom, size.top, format);
  const svg = make('svg:svg', {viewBox: `0 0 ${size.width} ${size.height}`, role: 'group', 'aria-label': `${name} against device time a frame`});
  drawAxes(svg, x, y, size, name);
  const noise = name === plotMeasures[0][1] ? drawNoise(svg, points, x, y, size) : '';
  for (const technique of techniqueNames) drawCurve(svg, points.filter((p) => p.technique.name === technique), x, y);
  drawPoints(svg, points, x, y, size, format, narrow);
  holder.append(svg);
  byId('plot-caption').textContent = `Lower left is better.${x.log || y.log ? ' Scales are logarithmic where values span more than a factor of eight.' : ''}${noise}`;
}

function drawAxes(svg, x, y, size, name) {
  const bottom = size.height - size.bottom, right = size.width - size.right;
  const whole = (tick) => Math.abs(Math.log10(tick) - Math.round(Math.log10(tick))) < 1e-9;  // powers of ten
  const thin = (ticks) => ticks.length > 8 ? ticks.filter(whole) : ticks;
  for (const tick of thin(x.ticks)) {
    const at = x.at(tick);
    svg.append(make('svg:line', {class: 'grid', x1: at, x2: at, y1: size.top, y2: bottom}),
      make('svg:text', {class: 'axis', x: at, y: bottom + 18, 'text-anchor': 'middle'}, tick === 0 ? '0' : String(Number(tick.toPrecision(2)))));
  }
  for (const tick of thin(y.ticks)) {
    const at = y.at(tick);
    svg.append(make('svg:line', {class: 'grid', x1: size.left, x2: right, y1: at, y2: at}),
      make('svg:text', {class: 'axis', x: size.left - 8, y: at + 4, 'text-anchor': 'end'}, tick === 0 ? '0' : y.format(tick, 1)));
  }
  svg.append(make('svg:text', {class: 'axis', x: right, y: size.height - 10, 'text-anchor': 'end'}, 'device time, ms a frame'),
    make('svg:text', {class: 'axis', x: size.left - 50, y: size.top - 6}, name));
}

/// The relative error that noise makes by itself: a line where it is the same for all, else a dash under each point, since what
/// techniques are held to is not the same light. Returns what the caption says of it.
function drawNoise(svg, points, x, y, size) {
  if (state.layer !== 'sum') return '';
  const noiseOf = ({technique}) => technique.reference_noise;
  const known = points.filter((p) => noiseOf(p) !== null);
  const shown = known.filter((p) => y.at(noiseOf(p)) > size.top && y.at(noiseOf(p)) < size.height - size.bottom);
  if (shown.length === 0) return '';
  const same = known.length === points.length && Math.max(...known.map(noiseOf)) < 1.05 * Math.min(...known.map(noiseOf));
  for (const point of same ? shown.slice(0, 1) : shown) {
    const at = y.at(noiseOf(point)), middle = x.at(point.x);
    const [from, to] = same ? [size.left, size.width - size.right] : [Math.max(middle - 22, size.left), Math.min(middle + 22, size.width - size.right)];
    svg.append(make('svg:line', {class: 'floor', x1: from, x2: to, y1: at, y2: at}, make('svg:title', {}, `noise of what ${same ? 'all are' : `${point.technique.label} is`} held to: ${percent(noiseOf(point))}`)));
  }
  return same ? ' Dashed: what the noise of the reference makes by itself.' : ' Dashed: what the noise of what each is held to makes by itself.';
}

function drawCurve(svg, points, x, y) {
  if (points.length < 2) return;
  const path = [...points].sort((a, b) => a.x - b.x).map((p, i) => `${i ? 'L' : 'M'}${x.at(p.x).toFixed(1)} ${y.at(p.y).toFixed(1)}`).join('');
  svg.append(make('svg:path', {class: 'curve', d: path, style: markOf(points[0].technique)}));
}

// Labels go to the right of their point, or to the left near the edge, and are moved up or down off each other.
function drawPoints(svg, points, x, y, size, format, narrow) {
  const taken = points.map((p) => ({left: x.at(p.x) - 8, right: x.at(p.x) + 8, top: y.at(p.y) - 8, bottom: y.at(p.y) + 8}));
  const free = (box) => taken.every((other) => box.right < other.left || box.left > other.right || box.bottom < other.top || box.top > other.bottom);
  for (const point of points) {
    const {technique} = point, px = x.at(point.x), py = y.at(point.y);
    const text = `${technique.label}: ${format(point.y)} at ${milliseconds(point.x)}`;
    const label = narrow && technique.label.length > 22 ? `${technique.label.slice(0, 21)}…` : technique.label;
    const long = label.length * 7;
    const candidates = [];
    for (const dy of [0, -16, 16, -32, 32, -48, 48]) for (const side of [1, -1]) candidates.push([side, dy]);
    const boxOf = ([side, dy]) => ({left: side > 0 ? px + 11 : px - 11 - long, right: side > 0 ? px + 11 + long : px - 11, top: py + dy - 7, bottom: py + dy + 7});
    const inside = (box) => box.right < size.width && box.left > size.left - 40 && box.top > 0 && box.bottom < size.height - size.bottom + 6;
    const chosen = candidates.find((c) => inside(boxOf(c)) && free(boxOf(c))) ?? [1, 0];
    taken.push(boxOf(chosen));
    svg.append(make('svg:g', {tabindex: 0, role: 'img', 'aria-label': text, style: markOf(technique), 'data-technique': point.index},
      make('svg:title', {}, text), make('svg:circle', {class: 'dot', cx: px, cy: py, r: 7}),
      make('svg:text', {class: 'label halo', x: px + 11 * chosen[0], y: py + chosen[1] + 4, 'text-anchor': chosen[0] > 0 ? 'start' : 'end', 'pointer-events': 'none'}, label)));
  }
}
