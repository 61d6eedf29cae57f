// Pictures as compare_page_pack.cpp packs them: for each channel, differences to the left neighbour modulo 2^16 (the first of
// a row to the one above), upper bytes, then lower bytes; zlib; base64. A map of bytes is packed alike, modulo 2^8.

const kHalfValues = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    values[bits] = exponent === 0 ? sign * mantissa * 2 ** -24
      : exponent === 31 ? (mantissa ? NaN : sign * Infinity) : sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
  }
  return values;
})();

function bytesOfBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(id) {
  const element = document.getElementById(id);
  const packed = bytesOfBase64(element.textContent);
  element.remove();  // its text would stay in memory beside the pixels
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// channels planes of width * height halves.
async function unpackHalves(id, width, height, channels) {
  const bytes = await inflated(id);
  const count = width * height;
  if (bytes.length !== count * channels * 2) throw new Error(`picture ${id} holds ${bytes.length} bytes`);
  const halves = new Uint16Array(count * channels);
  for (let c = 0; c < channels; ++c) {
    const upper = 2 * c * count, lower = upper + count, out = c * count;
    for (let y = 0, i = 0; y < height; ++y) {
      let value = y > 0 ? halves[out + i - width] : 0;
      for (let x = 0; x < width; ++x, ++i) {
        value = (value + (bytes[upper + i] << 8) + bytes[lower + i]) & 0xffff;
        halves[out + i] = value;
      }
    }
  }
  return halves;
}

async function unpackBytes(id, width, height) {
  const bytes = await inflated(id);
  if (bytes.length !== width * height) throw new Error(`map ${id} holds ${bytes.length} bytes`);
  for (let y = 0, i = 0; y < height; ++y) {
    let value = y > 0 ? bytes[i - width] : 0;
    for (let x = 0; x < width; ++x, ++i) bytes[i] = value = (value + bytes[i]) & 0xff;
  }
  return bytes;
}
