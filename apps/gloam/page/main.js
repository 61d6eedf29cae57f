// What the controls do, and the beginning of it all.

/// Buttons of which one is pressed, as a radio group: arrow keys move within it.
function choice(id, entries, chosen, change) {
  const group = byId(id);
  const buttons = entries.map(([value, text]) => make('button', {type: 'button', role: 'radio', 'data-value': value, onclick: () => press(value)}, text));
  const press = (value) => { mark(value), change(value); };
  const mark = (value) => buttons.forEach((button) => {
    const on = button.dataset.value === String(value);
    button.setAttribute('aria-checked', on), button.tabIndex = on ? 0 : -1;
  });
  group.append(...buttons);
  group.addEventListener('keydown', (event) => {
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    if (!step) return;
    event.preventDefault();
    const next = buttons[(buttons.indexOf(document.activeElement) + step + buttons.length) % buttons.length];
    next.focus(), press(next.dataset.value);
  });
  mark(chosen);
}

/// Where a picture stands in the narrow grid: techniques that are held to one reference, and then it; each such group begins a line.
function placeInPairs(index) {
  const pictures = page.pictures, count = pictures.length;
  const isTechnique = pictures[index].technique !== null, reference = isTechnique ? pictures[index].reference : index;
  const first = pictures.findIndex((picture) => picture.technique !== null && picture.reference === reference);
  const group = first < 0 ? count : first;
  return {order: group * (count + 1) + (isTechnique ? index : count), column: first < 0 || index === first ? '1' : 'auto'};
}

function arrange() {
  const stage = byId('stage');
  const techniques = page.pictures.map((_, i) => i).filter((i) => page.pictures[i].technique !== null);
  byId('swipe-tools').hidden = state.view !== 'swipe';
  byId('difference-tools').hidden = state.view !== 'difference';
  if (state.view === 'swipe') panes = [new Pane([state.left, state.right])];
  else if (state.view === 'difference') panes = techniques.map((i) => new Pane([i], true));
  else panes = page.pictures.map((_, i) => new Pane([i]));
  stage.classList.toggle('single', panes.length === 1);
  stage.classList.toggle('few', panes.length <= 2);
  stage.style.setProperty('--columns', panes.length <= 4 ? Math.max(panes.length, 2) : panes.length <= 6 || width > height ? 3 : 4);
  for (const pane of panes) {
    const {order, column} = placeInPairs(pane.shows[0]);
    pane.figure.style.setProperty('--in-pairs', order), pane.figure.style.setProperty('--column', column);
  }
  stage.replaceChildren(...panes.map((pane) => pane.figure));
  limitSingle();
  for (const pane of panes) pane.describe();
  updateLegend(), redraw();
  byId('hint').textContent = 'Wheel or two fingers zoom, dragging pans, a double click goes in and out; arrow keys move the probe. All pictures move together.';
}

// One picture alone fills the width, but never more than the height of the window.
function limitSingle() {
  if (panes.length === 1) panes[0].figure.style.maxWidth = `max(18rem, ${(78 * width / height).toFixed(1)}vh)`;
}

function updateLegend() {
  const kind = state.difference, bar = byId('legend-bar'), context = bar.getContext('2d');
  byId('factor-tool').hidden = kind !== 'difference';
  const image = context.createImageData(256, 1), out = new Float32Array(3);
  for (let i = 0; i < 256; ++i) {
    if (kind === 'difference') out.fill(i / 255);
    else mapped(colorMaps[kind], i / 255, out);
    image.data.set([255 * out[0], 255 * out[1], 255 * out[2], 255], 4 * i);
  }
  context.putImageData(image, 0, 0);
  const ends = {difference: ['darker', 'brighter'], false: ['0', `${significant(page.false_color_top, 2)} × mean`], flip: ['0', '1']}[kind];
  byId('legend-low').textContent = ends[0], byId('legend-high').textContent = ends[1];
}

function setExposure(stops) {
  state.display.exposure = stops;
  byId('exposure-value').textContent = `${stops > 0 ? '+' : ''}${stops.toFixed(2).replace('-', '−')} EV`;
  updateInspector(), redraw();
}

function setLayer(layer) {
  state.layer = layer;
  for (const pane of panes) pane.describe();
  updateMeasures(), updatePlot(), updateInspector(), redraw();
}

function buildControls() {
  choice('view-choice', [['grid', 'Side by side'], ['swipe', 'Slider'], ['difference', 'Difference']], state.view, (value) => { state.view = value; arrange(); });
  choice('layer-choice', layers, state.layer, setLayer);
  choice('curve-choice', [['filmic', 'Filmic'], ['linear', 'Linear']], 'filmic', (value) => { state.display.filmic = value === 'filmic'; updateInspector(), redraw(); });
  choice('difference-choice', [['difference', 'Difference'], ['false', 'False colour'], ['flip', 'FLIP']], state.difference,
    (value) => { state.difference = value; updateLegend(), redraw(); });
  const exposure = byId('exposure');
  exposure.value = state.display.exposure;
  exposure.addEventListener('input', () => setExposure(Number(exposure.value)));
  byId('factor').addEventListener('change', (event) => { state.factor = Number(event.target.value); redraw(); });
  byId('zoom-in').addEventListener('click', () => zoomAtProbe(1.5));
  byId('zoom-out').addEventListener('click', () => zoomAtProbe(1 / 1.5));
  byId('zoom-fit').addEventListener('click', fit);
  const best = sortedTechniques()[0] ?? 0;  // the nearest, beside its reference
  state.left = page.pictures.findIndex((picture) => picture.technique === best), state.right = page.pictures[state.left].reference;
  for (const side of ['left', 'right']) {
    const select = byId(`swipe-${side}`);
    select.append(...page.pictures.map((picture, i) => make('option', {value: i}, picture.label)));
    select.value = state[side];
    select.addEventListener('change', () => { state[side] = Number(select.value); arrange(); });
  }
}

async function start() {
  if (typeof DecompressionStream === 'undefined') throw new Error('this browser cannot inflate the pictures (it lacks DecompressionStream)');
  buildHead(), buildMeasures(), buildPlot(), buildAbout(), updateMeasures(), updatePlot();
  await unpackAll();
  buildControls(), buildInspector(), arrange();
  setExposure(state.display.exposure);
  setProbe([width >> 1, height >> 1]);
  new ResizeObserver(redraw).observe(byId('stage'));
  let plotWidth = byId('plot').clientWidth;
  window.addEventListener('resize', () => { if (byId('plot').clientWidth !== plotWidth) plotWidth = byId('plot').clientWidth, updatePlot(); });
  document.documentElement.dataset.ready = 'yes';
}

start().catch((error) => {
  const trouble = byId('trouble');
  trouble.textContent = `The pictures cannot be shown: ${error.message}`;
  trouble.hidden = false;
  throw error;
});
