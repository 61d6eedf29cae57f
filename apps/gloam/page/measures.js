// The table: a row a technique, sorted by any column; under each row its passes, what it covers, its settings.

const measureNames = ['rmse', 'relative_squared_error', 'psnr', 'ssim', 'flip', 'mean_signed_error'];
/// The measures of one layer of results.json.
const measuresOf = (technique, layer) => layer === 'sum' ? technique : technique[layer];

/// key, heading, what it says, the value, its text, and which is best: 'low', 'high', 'zero' or none.
const columns = [
  ['flip', 'FLIP', 'perceived, 0 to 1', (m) => m.flip, (v) => significant(v), 'low'],
  ['relative_squared_error', 'Rel. sq. error', '‖a−b‖² / ‖b‖²', (m) => m.relative_squared_error, (v) => significant(v), 'low'],
  ['rmse', 'RMSE', 'radiance', (m) => m.rmse, (v) => significant(v), 'low'],
  ['psnr', 'PSNR', 'dB', (m) => m.psnr, (v) => significant(v), 'high'],
  ['ssim', 'SSIM', '1 is equal', (m) => m.ssim, (v) => significant(v), 'high'],
  ['mean_signed_error', 'Signed', 'mean a−b', (m) => m.mean_signed_error, (v) => (v > 0 ? '+' : '') + significant(v), 'zero'],
  ['device_ms', 'Device', 'ms a frame', (m, t) => t.device_ms, (v) => significant(v), 'low'],
  ['memory_bytes', 'Memory', 'on the device', (m, t) => t.memory_bytes, bytesText, 'low'],
  ['bake_seconds', 'Bake', 'once', (m, t) => t.bake_seconds, secondsText, 'none'],
];
const sorting = {key: 'relative_squared_error', descending: false};
const open = new Set();

function buildMeasures() {
  const button = (key, text, small) => make('button', {type: 'button', 'data-sort': key, onclick: () => sortBy(key)}, make('span', {}, text), small ? make('small', {}, small) : null);
  byId('measures').tHead.append(make('tr', {},
    make('th', {scope: 'col', 'data-key': 'label'}, button('label', 'Technique')),
    columns.map(([key, heading, small]) => make('th', {scope: 'col', 'data-key': key}, button(key, heading, small)))));
  const select = byId('sort-by');  // where there is no room for a head
  select.append(make('option', {value: 'label'}, 'Technique'), ...columns.map(([key, heading]) => make('option', {value: key}, heading)));
  select.addEventListener('change', () => sortBy(select.value));
}

function sortBy(key) {
  const high = key === 'psnr' || key === 'ssim';  // best first
  sorting.descending = sorting.key === key ? !sorting.descending : high;
  sorting.key = key;
  updateMeasures();
}

function valueOf(technique, key) {
  if (key === 'label') return technique.label;
  return columns.find(([name]) => name === key)[3](measuresOf(technique, state.layer), technique);
}

/// Indices of results.techniques; those without a value come last either way.
function sortedTechniques() {
  const order = results.techniques.map((_, i) => i);
  const rank = (i) => {
    const value = valueOf(results.techniques[i], sorting.key);
    return sorting.key === 'mean_signed_error' && value !== null ? Math.abs(value) : value;
  };
  return order.sort((i, j) => {
    const a = rank(i), b = rank(j);
    if (a === null || b === null) return (a === null) - (b === null) || i - j;
    const less = typeof a === 'string' ? a.localeCompare(b) : a - b;
    return (sorting.descending ? -less : less) || i - j;
  });
}

function bestOf(column) {
  const [, , , value, , better] = column;
  const values = results.techniques.map((t) => value(measuresOf(t, state.layer), t)).filter((v) => v !== null && v !== undefined);
  if (values.length < 2 || better === 'none') return null;
  if (better === 'high') return Math.max(...values);
  if (better === 'low') return Math.min(...values);
  return values.reduce((a, b) => Math.abs(b) < Math.abs(a) ? b : a);
}

function updateMeasures() {
  const table = byId('measures');
  byId('sort-by').value = sorting.key;
  for (const heading of table.tHead.rows[0].cells) {
    heading.setAttribute('aria-sort', heading.dataset.key !== sorting.key ? 'none' : sorting.descending ? 'descending' : 'ascending');
  }
  for (const body of [...table.tBodies]) body.remove();
  const best = columns.map(bestOf);
  for (const index of sortedTechniques()) table.append(techniqueBody(index, best));
  const layerName = layers.find(([name]) => name === state.layer)[1].toLowerCase();
  byId('measures-note').textContent = `Of ${state.layer === 'sum' ? 'all light that a technique covers' : `${layerName} light`}, `
    + 'over the pixels in which a surface is seen that does not shine itself. The choice of light above the pictures holds here too. A technique’s name opens its passes and settings.';
}

function techniqueBody(index, best) {
  const technique = results.techniques[index];
  const toggle = make('button', {type: 'button', class: 'expander', 'aria-expanded': String(open.has(index)), 'aria-controls': `details-${index}`,
    onclick: () => { open.has(index) ? open.delete(index) : open.add(index); updateMeasures(); document.querySelector(`[data-technique="${index}"] .expander`).focus(); }}, technique.label);
  const missing = technique.leaves_out.length ? make('small', {}, `without ${lightWords(technique.leaves_out)}`) : null;
  const fewer = technique.bounces > 0 && technique.bounces < results.bounces ? make('small', {}, `without light of more than ${bouncesText(technique.bounces)}`) : null;
  const row = make('tr', {}, make('th', {scope: 'row'}, toggle, missing, fewer, technique.notes.map((note) => make('small', {}, note))),
    columns.map(([key, heading, , value, text], c) => {
      const v = value(measuresOf(technique, state.layer), technique) ?? null;
      return make('td', {'data-key': key, 'data-value': v, 'data-label': {device_ms: 'Device, ms', psnr: 'PSNR, dB'}[key] ?? heading, class: v !== null && v === best[c] ? 'best' : null,
        title: v === null ? nullReason(technique, key) : String(v)}, v === null ? '–' : text(v));
    }));
  const body = make('tbody', {'data-technique': index, style: markOf(technique)}, row);
  if (open.has(index)) body.append(make('tr', {class: 'details', id: `details-${index}`}, make('td', {colspan: columns.length + 1}, details(technique))));
  return body;
}

function nullReason(technique, key) {
  if (key === 'bake_seconds') return technique.bake_note || 'needs no bake';
  return 'no such light here';
}

function details(technique) {
  const most = Math.max(...technique.passes.map((pass) => pass.median_ms), 1e-9);
  const passes = make('table', {class: 'passes'},
    make('tr', {}, make('th', {scope: 'col'}, 'pass'), make('td', {}, 'median ms'), make('td', {}, '95 %'), make('td', {class: 'bar'})),
    technique.passes.map((pass) => make('tr', {}, make('th', {scope: 'row'}, pass.name), make('td', {}, significant(pass.median_ms)),
      make('td', {}, significant(pass.p95_ms)), make('td', {class: 'bar'}, make('i', {style: `width: ${100 * pass.median_ms / most}%`})))));
  const list = (entries) => make('dl', {}, entries.flatMap(([term, text]) => [make('dt', {}, term), make('dd', {}, text)]));
  return make('div', {class: 'details-grid'},
    make('div', {}, make('h3', {}, `Passes (${milliseconds(technique.device_ms)} together, ${milliseconds(technique.frame_ms)} by the clock)`), passes),
    make('div', {}, make('h3', {}, 'Light and settings'), list([
      ['covers', lightWords(technique.covers)],
      ['leaves out', lightWords(technique.leaves_out) || 'nothing that this scene has'],
      ['bounces', technique.own_bounces === technique.bounces ? String(technique.bounces) : `${technique.own_bounces}, held to ${technique.bounces}`],
      ...Object.entries(technique.settings).map(([name, value]) => [name, String(value)]),
      ...(technique.bake_note ? [['bake', technique.bake_note]] : []),
      ...technique.notes.map((note) => ['note', note]),
    ])));
}
