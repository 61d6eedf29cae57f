// Panes that show one place of all pictures at one magnification; a probe that stands on the same pixel of each.

const state = {
  view: 'grid', layer: 'sum', difference: 'difference', factor: 2,
  display: {exposure: page.exposure_stops, filmic: true},
  zoom: 1, center: [0.5, 0.5],  // zoom 1: the whole picture fills its pane
  probe: null, left: 0, right: 0, divider: 0.5,
};
let panes = [];

/// Canvases of whole pictures, made when first shown and thrown away when what they show changes.
const painting = {key: '', canvases: new Map()};
function canvasOf(index, difference) {
  const key = JSON.stringify([state.layer, state.display, state.difference, state.factor]);
  if (painting.key !== key) painting.key = key, painting.canvases.clear();
  const name = `${index}${difference ? 'd' : ''}`;
  if (!painting.canvases.has(name)) {
    const picture = page.pictures[index];
    painting.canvases.set(name, difference
      ? differenceCanvas(picture, state.layer, state.difference, state.factor, state.display)
      : pictureCanvas(picture, state.layer, state.display));
  }
  return painting.canvases.get(name);
}

class Pane {
  /// shows: [index] or [left, right] of page.pictures.
  constructor(shows, difference = false) {
    this.shows = shows, this.difference = difference;
    this.canvas = make('canvas', {tabindex: 0, role: 'img', 'data-picture': shows.join(' ')});
    this.probe = make('div', {class: 'probe', hidden: true});
    this.box = make('div', {class: 'pane', style: `aspect-ratio: ${width} / ${height}`}, this.canvas, this.probe);
    if (shows.length === 2) this.addDivider();
    this.figure = make('figure', {}, this.box);
    if (shows.length === 1) this.addCaption();
    this.pointers = new Map();
    this.listen();
  }

  addCaption() {
    const picture = page.pictures[this.shows[0]];
    const technique = picture.technique === null ? null : results.techniques[picture.technique];
    this.figures = make('span', {class: 'figures'});
    this.figure.append(make('figcaption', {style: technique ? markOf(technique) : null},
      make('span', {class: technique ? 'name' : 'name reference'}, picture.label), this.figures));
  }

  addDivider() {
    this.divider = make('div', {class: 'divider', role: 'slider', tabindex: 0, 'aria-label': 'Divider between left and right picture',
      'aria-valuemin': 0, 'aria-valuemax': 100, 'aria-orientation': 'horizontal'});
    this.corners = ['left', 'right'].map((side) => make('div', {class: `corner ${side}`}));
    this.box.append(...this.corners, this.divider);
    const move = (share) => { state.divider = Math.min(Math.max(share, 0), 1); this.draw(); };
    this.divider.addEventListener('pointerdown', (event) => { this.divider.setPointerCapture(event.pointerId); event.stopPropagation(); });
    this.divider.addEventListener('pointermove', (event) => {
      event.stopPropagation();
      if (!this.divider.hasPointerCapture(event.pointerId)) return;
      const box = this.box.getBoundingClientRect();
      move((event.clientX - box.left) / box.width);
    });
    this.divider.addEventListener('keydown', (event) => {
      const step = {ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1}[event.key];
      if (step === undefined) return;
      event.preventDefault(), event.stopPropagation();
      move(state.divider + step);
    });
  }

  /// CSS pixels a picture's pixel takes, and where the picture's corner stands in the pane.
  place() {
    const w = this.box.clientWidth, h = this.box.clientHeight;
    const scale = state.zoom * Math.min(w / width, h / height);
    return {w, h, scale, x: w / 2 - state.center[0] * width * scale, y: h / 2 - state.center[1] * height * scale};
  }

  pixelAt(event) {
    const box = this.box.getBoundingClientRect(), {scale, x, y} = this.place();
    const px = Math.floor((event.clientX - box.left - x) / scale), py = Math.floor((event.clientY - box.top - y) / scale);
    return px >= 0 && py >= 0 && px < width && py < height ? [px, py] : null;
  }

  draw() {
    const {w, h, scale, x, y} = this.place();
    if (w === 0) return;
    const ratio = window.devicePixelRatio || 1;
    const cw = Math.round(w * ratio), ch = Math.round(h * ratio);
    if (this.canvas.width !== cw || this.canvas.height !== ch) this.canvas.width = cw, this.canvas.height = ch;
    const context = this.canvas.getContext('2d');
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, cw, ch);
    context.imageSmoothingEnabled = state.zoom === 1 || scale * ratio < 1.5;
    context.imageSmoothingQuality = 'high';
    const paint = (index) => context.drawImage(canvasOf(index, this.difference), x * ratio, y * ratio, width * scale * ratio, height * scale * ratio);
    paint(this.shows[0]);
    if (this.shows.length === 2) this.drawRight(context, paint, cw, ch);
    this.box.classList.toggle('zoomed', state.zoom > 1);
    this.drawProbe();
  }

  drawRight(context, paint, cw, ch) {
    const edge = Math.round(state.divider * cw);
    context.save();
    context.beginPath(), context.rect(edge, 0, cw - edge, ch), context.clip();
    context.clearRect(edge, 0, cw - edge, ch);
    paint(this.shows[1]);
    context.restore();
    this.divider.style.left = `${100 * state.divider}%`;
    this.divider.setAttribute('aria-valuenow', Math.round(100 * state.divider));
  }

  drawProbe() {
    this.probe.hidden = state.probe === null;
    if (state.probe === null) return;
    const {scale, x, y} = this.place();
    const size = Math.max(11, scale + 3);
    const px = x + (state.probe[0] + 0.5) * scale - size / 2, py = y + (state.probe[1] + 0.5) * scale - size / 2;
    this.probe.style.cssText = `width: ${size}px; height: ${size}px; transform: translate(${px}px, ${py}px)`;
  }

  describe() {
    const names = this.shows.map((index) => page.pictures[index].label);
    const light = layers.find(([name]) => name === state.layer)[1].toLowerCase();
    const technique = page.pictures[this.shows[0]].technique;
    const measures = technique === null ? null : measuresOf(results.techniques[technique], state.layer);
    const figures = measures && measures.rmse !== null
      ? `${percent(Math.sqrt(measures.relative_squared_error ?? NaN))} error, FLIP ${significant(measures.flip)}`
      : technique !== null && claimsNone(page.pictures[this.shows[0]], state.layer) ? `claims no ${light} light` : '';
    if (this.figures) this.figures.textContent = figures;
    if (this.corners) this.corners.forEach((corner, i) => { corner.textContent = names[i]; });
    const what = this.shows.length === 2 ? `${names[0]} left of the divider, ${names[1]} right of it`
      : this.difference ? `difference of ${names[0]} to its reference` : names[0];
    this.canvas.setAttribute('aria-label', `${what}; ${light}${figures ? `; ${figures}` : ''}. Arrow keys move the probe, plus and minus zoom.`);
  }

  listen() {
    const box = this.box;
    box.addEventListener('pointerdown', (event) => this.down(event));
    box.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel']) box.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    box.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    box.addEventListener('dblclick', (event) => {
      if (state.zoom > 1) fit();
      else zoomBy(Math.max(4, 8 / this.place().scale), this, event.clientX, event.clientY);
    });
    this.canvas.addEventListener('keydown', (event) => this.key(event));
  }

  down(event) {
    this.canvas.focus({preventScroll: true});
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (state.zoom > 1 || this.pointers.size > 1) this.box.setPointerCapture(event.pointerId);
    setProbe(this.pixelAt(event));
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === 'mouse') setProbe(this.pixelAt(event));
      return;
    }
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (others.length > 0) {  // two fingers: the distance between them zooms, their middle pans
      const [ox, oy] = others[0];
      const was = Math.hypot(before[0] - ox, before[1] - oy), is = Math.hypot(event.clientX - ox, event.clientY - oy);
      if (was > 0) zoomBy(is / was, this, (event.clientX + ox) / 2, (event.clientY + oy) / 2);
      panBy(this, (event.clientX - before[0]) / 2, (event.clientY - before[1]) / 2);
    } else if (state.zoom > 1) {
      panBy(this, event.clientX - before[0], event.clientY - before[1]);
    } else {
      setProbe(this.pixelAt(event));
    }
  }

  // At its whole, a picture lets the wheel scroll the page on, and so it does while the page is still rolling.
  wheel(event) {
    const step = event.deltaY * (event.deltaMode === 1 ? 16 : 1);
    if (!event.ctrlKey && (performance.now() - lastScroll < 350 || (state.zoom === 1 && step > 0))) return;
    event.preventDefault();
    zoomBy(Math.exp(-step * (event.ctrlKey ? 0.01 : 0.0025)), this, event.clientX, event.clientY);
    setProbe(this.pixelAt(event));
  }

  key(event) {
    const step = event.shiftKey ? 10 : 1;
    const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]};
    const at = state.probe ?? [width >> 1, height >> 1];
    if (moves[event.key]) {
      setProbe([Math.min(Math.max(at[0] + moves[event.key][0], 0), width - 1), Math.min(Math.max(at[1] + moves[event.key][1], 0), height - 1)], true);
    } else if (event.key === '+' || event.key === '=') zoomAtProbe(1.5);
    else if (event.key === '-') zoomAtProbe(1 / 1.5);
    else if (event.key === '0') fit();
    else return;
    event.preventDefault();
  }
}

let lastScroll = -Infinity;
window.addEventListener('scroll', () => { lastScroll = performance.now(); }, {passive: true});

function keepInside() {
  const least = 0.5 / state.zoom;
  for (let i = 0; i < 2; ++i) state.center[i] = Math.min(Math.max(state.center[i], least), 1 - least);
}

function zoomBy(factor, pane, clientX, clientY) {
  const {w, h, scale} = pane.place();
  const most = Math.max(64 / (scale / state.zoom), 1);
  const zoom = Math.min(Math.max(state.zoom * factor, 1), most);
  const box = pane.box.getBoundingClientRect();
  const fx = (clientX - box.left - w / 2) / (width * scale), fy = (clientY - box.top - h / 2) / (height * scale);
  const still = 1 - state.zoom / zoom;
  state.center[0] += fx * still, state.center[1] += fy * still;
  state.zoom = zoom;
  keepInside(), redraw();
}

function zoomAtProbe(factor) {
  const at = state.probe ?? [width / 2, height / 2];
  state.zoom = Math.min(Math.max(state.zoom * factor, 1), 512);
  state.center = [(at[0] + 0.5) / width, (at[1] + 0.5) / height];
  keepInside(), redraw();
}

function panBy(pane, dx, dy) {
  const {scale} = pane.place();
  state.center[0] -= dx / (width * scale), state.center[1] -= dy / (height * scale);
  keepInside(), redraw();
}

function fit() {
  state.zoom = 1, state.center = [0.5, 0.5];
  redraw();
}

let drawPending = false;
function redraw() {
  if (drawPending) return;
  drawPending = true;
  requestAnimationFrame(() => {
    drawPending = false;
    for (const pane of panes) pane.draw();
    const scale = panes.length ? panes[0].place().scale * (window.devicePixelRatio || 1) * page.shrink : 1;
    byId('zoom-value').textContent = `${significant(100 * scale / page.shrink, 2)} %`;
  });
}
