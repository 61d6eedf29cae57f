// The values under the cursor, of all pictures at once.

let inspectorRows = [];

function buildInspector() {
  const body = byId('inspector').tBodies[0];
  inspectorRows = page.pictures.map((picture) => {
    const swatch = make('span', {class: 'swatch', 'aria-hidden': 'true'});
    const cells = [0, 1, 2, 3].map(() => make('td', {}, '–'));
    body.append(make('tr', {}, make('th', {scope: 'row', title: picture.label}, swatch, picture.label), cells));
    return {swatch, cells};
  });
}

/// |a - b| over |b| of a pixel; and whether a is brighter.
function pixelError(picture, layer, pixel) {
  const reference = page.pictures[picture.reference], weights = [0.2126, 0.7152, 0.0722];
  let difference = 0, norm = 0, brighter = 0;
  for (let c = 0; c < 3; ++c) {
    const a = valueAt(picture, layer, c, pixel), b = valueAt(reference, layer, c, pixel);
    difference += (a - b) ** 2, norm += b * b, brighter += weights[c] * (a - b);
  }
  return {relative: Math.sqrt(difference / norm), brighter};
}

function errorText(picture, pixel) {
  if (picture.reference === null) return '';
  const technique = results.techniques[picture.technique];
  if (state.layer !== 'sum' && technique[state.layer].rmse === null) return '–';  // it claims none of that light
  const {relative, brighter} = pixelError(picture, state.layer, pixel);
  if (Number.isNaN(relative)) return '0 %';
  return `${brighter > 0 ? '▲' : brighter < 0 ? '▼' : ''} ${Number.isFinite(relative) ? percent(relative) : '∞'}`.trim();
}

function updateInspector() {
  const place = byId('inspector-place');
  if (state.probe === null) { place.textContent = 'Point at a picture'; return; }
  const [x, y] = state.probe, pixel = y * width + x, shrink = page.shrink;
  place.textContent = `Pixel ${x * shrink}, ${y * shrink} · linear radiance · error ▲ brighter, ▼ darker than the reference`;
  const out = new Float32Array(3);
  page.pictures.forEach((picture, index) => {
    const {swatch, cells} = inspectorRows[index];
    const values = [0, 1, 2].map((c) => valueAt(picture, state.layer, c, pixel));
    shown(...values, 2 ** state.display.exposure, state.display.filmic, out);
    swatch.style.background = `rgb(${[...out].map((v) => Math.round(255 * v)).join(' ')})`;
    values.forEach((value, c) => { cells[c].textContent = significant(value, 4); cells[c].dataset.value = value; });
    cells[3].textContent = errorText(picture, pixel);
  });
}

function setProbe(pixel, spoken = false) {
  if (pixel === null) return;
  state.probe = pixel;
  for (const pane of panes) pane.drawProbe();
  updateInspector();
  if (!spoken) return;
  const rows = page.pictures.map((picture, i) => `${picture.label} ${inspectorRows[i].cells.slice(0, 3).map((cell) => cell.textContent).join(' ')}`);
  byId('spoken').textContent = `Pixel ${pixel.join(', ')}: ${rows.join('; ')}`;
}
