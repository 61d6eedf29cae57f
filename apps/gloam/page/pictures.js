// The pictures' values, and how they become colours: src/image/tonemap.h and the difference pictures of gloam/metrics.h.

const data = JSON.parse(document.getElementById('data').textContent);
const results = data.results, page = data.page;
const width = page.width, height = page.height, pixelCount = width * height;
const layers = [['sum', 'All light'], ['direct', 'Direct'], ['indirect', 'Indirect']];
let alpha = null;  // bytes, or null where every pixel is covered

async function unpackAll() {
  if (page.alpha) alpha = await unpackBytes(page.alpha, width, height);
  for (const picture of page.pictures) {
    picture.values = {};
    for (const layer of ['direct', 'indirect']) {
      picture.values[layer] = picture.blobs[layer] ? await unpackHalves(picture.blobs[layer], width, height, 3) : null;
    }
    picture.maps = {};
    for (const [layer] of layers) {
      if (picture.flip && picture.flip[layer]) picture.maps[layer] = await unpackBytes(picture.flip[layer], width, height);
    }
  }
}

/// Linear radiance of one channel at a pixel.
function valueAt(picture, layer, channel, pixel) {
  const {direct, indirect} = picture.values, i = channel * pixelCount + pixel;
  let value = 0;
  if (layer !== 'indirect' && direct) value += kHalfValues[direct[i]];
  if (layer !== 'direct' && indirect) value += kHalfValues[indirect[i]];
  return value;
}

function hasLayer(picture, layer) {
  return layer === 'sum' || picture.values[layer] !== null;
}

const kFilmicScale = 1.46193;
const filmicCurve = (x) => (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
const kSignalSteps = 4096;
/// Linear 0 to 1 in steps, as the sRGB signal 0 to 1.
const kSignal = Float32Array.from({length: kSignalSteps + 2}, (_, i) => {
  const linear = Math.min(i / kSignalSteps, 1);
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
});
function signalOf(linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  if (linear < 0.01) return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
  const at = linear * kSignalSteps, below = Math.floor(at);
  return kSignal[below] + (at - below) * (kSignal[below + 1] - kSignal[below]);
}

/// The display's signal, 0 to 1, of a radiance; written to out[0..2].
function shown(r, g, b, scale, filmic, out) {
  r = r > 0 ? Math.min(r * scale, 1e6) : 0;
  g = g > 0 ? Math.min(g * scale, 1e6) : 0;
  b = b > 0 ? Math.min(b * scale, 1e6) : 0;
  if (filmic) {
    const s = kFilmicScale;
    const x = filmicCurve(s * (0.59719 * r + 0.35458 * g + 0.04823 * b));
    const y = filmicCurve(s * (0.07600 * r + 0.90834 * g + 0.01566 * b));
    const z = filmicCurve(s * (0.02840 * r + 0.13383 * g + 0.83777 * b));
    r = 1.60475 * x - 0.53108 * y - 0.07367 * z;
    g = -0.10208 * x + 1.10813 * y - 0.00605 * z;
    b = -0.00327 * x - 0.07276 * y + 1.07602 * z;
  }
  out[0] = signalOf(r), out[1] = signalOf(g), out[2] = signalOf(b);
}

/// `filled(pixel, out)` writes a signal of 0 to 1; the canvas gets it, clear where the scene has no surface.
function painted(filled) {
  const canvas = document.createElement('canvas');
  canvas.width = width, canvas.height = height;
  const context = canvas.getContext('2d');
  const image = context.createImageData(width, height);
  const rgba = image.data, out = new Float32Array(3);
  for (let pixel = 0, i = 0; pixel < pixelCount; ++pixel, i += 4) {
    filled(pixel, out);
    rgba[i] = 255 * out[0], rgba[i + 1] = 255 * out[1], rgba[i + 2] = 255 * out[2];  // clamped and rounded by its type
    rgba[i + 3] = alpha ? alpha[pixel] : 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/// Partly covered pixels hold light times coverage; a canvas wants the light of what covers.
function pictureCanvas(picture, layer, display) {
  const scale = 2 ** display.exposure;
  return painted((pixel, out) => {
    const share = alpha && alpha[pixel] > 0 ? 255 / alpha[pixel] : 1;
    shown(valueAt(picture, layer, 0, pixel) * share, valueAt(picture, layer, 1, pixel) * share,
          valueAt(picture, layer, 2, pixel) * share, scale, display.filmic, out);
  });
}

/// Of R + G + B; 1 where that is not above 0.
function meanOf(picture, layer) {
  picture.means ??= {};
  if (picture.means[layer] === undefined) {
    let sum = 0;
    for (let c = 0; c < 3; ++c) for (let p = 0; p < pixelCount; ++p) sum += valueAt(picture, layer, c, p);
    picture.means[layer] = sum > 0 ? sum / pixelCount : 1;
  }
  return picture.means[layer];
}

const colorMaps = {
  false: bytesOfBase64(page.color_maps.false_color),
  flip: bytesOfBase64(page.color_maps.flip),
};
function mapped(colors, value, out) {
  const i = 3 * Math.round(255 * Math.min(Math.max(value, 0), 1));
  out[0] = colors[i] / 255, out[1] = colors[i + 1] / 255, out[2] = colors[i + 2] / 255;
}

/// A technique that is not to have such light is neither right nor wrong about it.
function claimsNone(picture, layer) {
  return picture.technique !== null && layer !== 'sum' && results.techniques[picture.technique][layer].rmse === null;
}
function hatched() {
  return painted((pixel, out) => out.fill((pixel % width + Math.floor(pixel / width)) % 8 < 2 ? 0.32 : 0.24));
}

/// kind: "difference" (times a factor, grey where equal), "false" (|a - b| over the reference's mean), "flip".
function differenceCanvas(picture, layer, kind, factor, display) {
  const reference = page.pictures[picture.reference];
  if (claimsNone(picture, layer)) return hatched();
  if (kind === 'flip') {
    const map = picture.maps[layer];
    return painted((pixel, out) => mapped(colorMaps.flip, map ? map[pixel] / 255 : 0, out));
  }
  if (kind === 'false') {
    const mean = meanOf(reference, layer);
    return painted((pixel, out) => {
      let sum = 0;
      for (let c = 0; c < 3; ++c) sum += Math.abs(valueAt(picture, layer, c, pixel) - valueAt(reference, layer, c, pixel));
      mapped(colorMaps.false, sum / mean / page.false_color_top, out);
    });
  }
  const scale = 2 ** display.exposure, a = new Float32Array(3), b = new Float32Array(3);
  const show = (which, pixel, out) => shown(valueAt(which, layer, 0, pixel), valueAt(which, layer, 1, pixel),
                                            valueAt(which, layer, 2, pixel), scale, display.filmic, out);
  return painted((pixel, out) => {
    show(picture, pixel, a), show(reference, pixel, b);
    for (let c = 0; c < 3; ++c) out[c] = 0.5 + 0.5 * factor * (a[c] - b[c]);
  });
}
