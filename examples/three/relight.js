// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A reader of GLOAM_precomputed_transfer for three.js, written from docs/formats/ alone: shows a baked .glb under a lamp that can
// be turned, relit on every change. make_page.py puts it into one file with three.js and the model.
import * as THREE from 'three';

// ---- The file --------------------------------------------------------------------------------------------------------

class Glb {
  constructor(buffer) {
    const head = new DataView(buffer);
    if (buffer.byteLength < 28 || head.getUint32(0, true) !== 0x46546c67 || head.getUint32(4, true) !== 2)
      throw new Error('not a glTF 2.0 binary');
    const size = head.getUint32(12, true);
    this.json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, size)));
    this.start = 28 + size;
    this.buffer = buffer;
  }

  /// Elements of an accessor end to end; halves are bits in unsigned shorts.
  numbers(index, expected, half = false) {
    const accessor = this.json.accessors?.[index];
    if (!accessor) throw new Error(`accessors[${index}] is missing`);
    const view = this.json.bufferViews[accessor.bufferView];
    const components = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4}[accessor.type], type = accessor.componentType;
    const size = {5121: 1, 5123: 2, 5125: 4, 5126: 4}[type], count = accessor.count;
    if (!size || !components) throw new Error(`accessors[${index}] is of an unexpected type`);
    if (expected !== undefined && count !== expected)
      throw new Error(`accessors[${index}] has ${count} elements, ${expected} were expected`);
    const stride = view.byteStride || size * components;
    const data = new DataView(this.buffer, this.start + (view.byteOffset || 0) + (accessor.byteOffset || 0));
    const values = type === 5126 || half ? new Float32Array(count * components) : new Uint32Array(count * components);
    for (let i = 0; i < values.length; ++i) {
      const at = Math.floor(i / components) * stride + (i % components) * size;
      values[i] = type === 5126 ? data.getFloat32(at, true) : type === 5125 ? data.getUint32(at, true)
        : type === 5121 ? data.getUint8(at) : half ? fromHalf(data.getUint16(at, true)) : data.getUint16(at, true);
      if (!Number.isFinite(values[i])) throw new Error(`accessors[${index}] holds what is not a number`);
    }
    return values;
  }
}

function fromHalf(h) {
  const exponent = (h >> 10) & 31, mantissa = h & 1023, sign = h & 0x8000 ? -1 : 1;
  if (exponent === 31) return NaN;
  return sign * (exponent ? (1024 + mantissa) * 2 ** (exponent - 25) : mantissa * 2 ** -24);
}

/// CRC-32 of positions and indices, as 32-bit words.
function checksum(positions, indices) {
  let crc = -1;
  const add = (word) => {
    crc ^= word;
    for (let bit = 0; bit < 32; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  };
  new Uint32Array(positions.buffer).forEach(add);
  indices.forEach(add);
  return ((crc ^ -1) >>> 0).toString(16).padStart(8, '0');
}

// ---- Transfer --------------------------------------------------------------------------------------------------------

/// Diffuse transfer of a primitive's vertices. Compressed transfer is lit as it lies: a cluster's mean and vectors once, then
/// a weight and a colour a vector for each vertex.
export class Transfer {
  constructor(glb, extension, positions, indices) {
    if (![1, 2, 3].includes(extension.version)) throw new Error(`version ${extension.version} is not known`);
    if (extension.texels) throw new Error('transfer of texels is not read here');
    if (extension.geometry !== checksum(positions, indices)) throw new Error('the transfer belongs to another mesh');
    const half = extension.format === 'half', pca = extension.pca;
    this.points = positions.length / 3;
    this.count = extension.order ** 2;
    this.width = extension.bounces > 0 ? 4 * this.count : this.count;
    if (!pca) {
      this.direct = glb.numbers(extension.direct, this.points * this.count, half);
      if (extension.bounces > 0) this.indirect = glb.numbers(extension.indirect, 3 * this.points * this.count, half);
      return;
    }
    this.clusters = pca.clusters, this.vectors = pca.vectors;
    this.means = glb.numbers(pca.means, pca.clusters * this.width, half);
    this.basis = glb.numbers(pca.basis, pca.clusters * pca.vectors * this.width, half);
    this.weights = glb.numbers(pca.weights, this.points * pca.vectors, half);
    this.cluster = glb.numbers(pca.cluster, this.points);
    if (this.cluster.some((c) => c >= pca.clusters)) throw new Error('a cluster that is not there');
  }

  /// n^2 numbers, and 3 n^2 with bounces, against the light: red, green, blue.
  lit(direct, d, indirect, i, light) {
    const sum = [0, 0, 0];
    for (let k = 0; k < this.count; ++k)
      for (let c = 0; c < 3; ++c)
        sum[c] += light[3 * k + c] * (direct[d + k] + (indirect ? indirect[i + 3 * k + c] : 0));
    return sum;
  }

  /// Irradiance of every vertex; `light` is [coefficient][rgb] in the object's axes.
  irradiance(light, out = new Float32Array(3 * this.points)) {
    if (!this.means) {
      for (let p = 0; p < this.points; ++p)
        out.set(this.lit(this.direct, p * this.count, this.indirect, 3 * p * this.count, light), 3 * p);
      return out;
    }
    const row = (array, at) => this.lit(array, at, this.width > this.count ? array : null, at + this.count, light);
    const tables = new Float32Array(3 * this.clusters * (this.vectors + 1));  // [cluster][mean, vectors][rgb]
    for (let c = 0; c < this.clusters; ++c) {
      tables.set(row(this.means, c * this.width), 3 * c * (this.vectors + 1));
      for (let m = 0; m < this.vectors; ++m)
        tables.set(row(this.basis, (c * this.vectors + m) * this.width), 3 * (c * (this.vectors + 1) + m + 1));
    }
    for (let p = 0; p < this.points; ++p) {
      let at = 3 * this.cluster[p] * (this.vectors + 1);
      let red = tables[at], green = tables[at + 1], blue = tables[at + 2];
      for (let m = 0; m < this.vectors; ++m) {
        const weight = this.weights[p * this.vectors + m];
        at += 3, red += weight * tables[at], green += weight * tables[at + 1], blue += weight * tables[at + 2];
      }
      out[3 * p] = red, out[3 * p + 1] = green, out[3 * p + 2] = blue;
    }
    return out;
  }
}

// ---- Light -----------------------------------------------------------------------------------------------------------

/// y_lm at a unit vector, by the document's general formula.
function basis(l, m, [x, y, z]) {
  const a = Math.abs(m);
  let cosine = 1, sine = 0, n = ((a ? 2 : 1) * (2 * l + 1)) / (4 * Math.PI), p = 1, before = 0;
  for (let k = 0; k < a; ++k) {
    [cosine, sine] = [x * cosine - y * sine, x * sine + y * cosine];
    p *= 2 * k + 1;
  }
  for (let k = l - a + 1; k <= l + a; ++k) n /= k;
  for (let k = a; k < l; ++k) [before, p] = [p, ((2 * k + 1) * z * p - (k + a) * before) / (k - a + 1)];
  return Math.sqrt(n) * p * (m < 0 ? sine : cosine);
}

/// A lamp from afar that gives `irradiance` (rgb) to what faces it, and the same radiance from everywhere. `soft`: bands are
/// windowed (Lanczos), so that the lamp is broad instead of ringing.
export function lightOf(order, towards, irradiance, ambient, soft = false) {
  const light = [];
  for (let l = 0; l < order; ++l) {
    const angle = (Math.PI * l) / (order + 1), window = soft && l > 0 ? Math.sin(angle) / angle : 1;
    for (let m = -l; m <= l; ++m)
      for (let c = 0; c < 3; ++c)
        light.push(window * irradiance[c] * basis(l, m, towards) + (l === 0 ? ambient[c] * Math.sqrt(4 * Math.PI) : 0));
  }
  return light;
}

/// The orthogonal factor Q of a matrix's polar decomposition.
function rotationOf(matrix) {
  const q = new THREE.Matrix3().setFromMatrix4(matrix), inverse = new THREE.Matrix3();
  for (let step = 0; step < 50; ++step) {
    inverse.copy(q).invert().transpose();
    q.elements.forEach((v, i) => (q.elements[i] = 0.5 * (v + inverse.elements[i])));
  }
  return q;
}

// ---- The model -------------------------------------------------------------------------------------------------------

/// Baked primitives as three.js meshes whose vertex colours are radiance. `unshown`: what the file has and they do not show.
export function loadBaked(buffer) {
  const glb = new Glb(buffer), json = glb.json, root = new THREE.Group(), lit = [], unshown = new Set();
  const addPrimitive = (primitive, node) => {
    const extension = primitive.extensions?.GLOAM_precomputed_transfer;
    if (!extension) return;
    const positions = glb.numbers(primitive.attributes.POSITION);
    const indices = primitive.indices === undefined ? Uint32Array.from({length: positions.length / 3}, (_, i) => i)
      : glb.numbers(primitive.indices);
    const material = json.materials?.[primitive.material]?.pbrMetallicRoughness || {};
    const base = material.baseColorFactor || [1, 1, 1, 1], metallic = material.metallicFactor ?? 1;
    if (metallic > 0) unshown.add(metallic > 0.5 ? 'what metals mirror (they are black)' : 'what metals mirror');
    if (material.baseColorTexture) unshown.add('textures');
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(positions.length), 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({vertexColors: true, side: THREE.DoubleSide}));
    node.add(mesh);
    const reflectance = [0, 1, 2].map((c) => base[c] * (1 - metallic));
    lit.push({mesh, reflectance, order: extension.order, transfer: new Transfer(glb, extension, positions, indices)});
  };
  const addNode = (index, parent) => {
    const source = json.nodes[index], node = new THREE.Group();
    if (source.matrix) node.applyMatrix4(new THREE.Matrix4().fromArray(source.matrix));
    if (source.translation) node.position.fromArray(source.translation);
    if (source.rotation) node.quaternion.fromArray(source.rotation);
    if (source.scale) node.scale.fromArray(source.scale);
    parent.add(node);
    if (source.mesh !== undefined) json.meshes[source.mesh].primitives.forEach((p) => addPrimitive(p, node));
    (source.children || []).forEach((child) => addNode(child, node));
  };
  json.scenes[json.scene || 0].nodes.forEach((index) => addNode(index, root));
  if (lit.length === 0) throw new Error('holds no baked transfer');
  root.updateMatrixWorld(true);
  return {root, lit, unshown: [...unshown]};
}

/// Fills vertex colours: reflectance / pi times irradiance. `towards` is a unit vector in the world.
export function relight(lit, towards, irradiance, ambient, soft = true) {
  for (const part of lit) {
    const q = rotationOf(part.mesh.matrixWorld).transpose();
    const own = new THREE.Vector3(...towards).applyMatrix3(q).toArray();
    part.irradiance = part.transfer.irradiance(lightOf(part.order, own, irradiance, ambient, soft), part.irradiance);
    const colors = part.mesh.geometry.attributes.color;
    for (let i = 0; i < colors.array.length; ++i)
      colors.array[i] = (Math.max(0, part.irradiance[i]) * part.reflectance[i % 3]) / Math.PI;
    colors.needsUpdate = true;
  }
}
