// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_state.h"

#include <algorithm>
#include <cstring>

#include "techniques/prt/prt_bake_kernels.h"

namespace gloam::prt {

std::size_t BakeState::blocksDone() const {
  std::size_t done = 0;
  for (std::size_t b = 0; b < blocks; ++b) done += block_done[b].load(std::memory_order_acquire);
  return done;
}

void BakeState::finishPass() {
  if (pass > 0) {
    for (std::size_t i = 0; i < indirect.size(); ++i) indirect[i] += next[i];
    previous.swap(next);
  } else if (bounces > 0) {
    const std::size_t stride = rowStride(coefficients);
    const std::size_t count = std::size_t(coefficients);
    for (std::size_t p = 0; p < points; ++p) {
      for (std::size_t color = 0; color < 3; ++color) {
        std::copy_n(&direct[p * count], count, &previous[p * row + color * stride]);
      }
    }
  }
  ++pass;
  for (std::size_t b = 0; b < blocks; ++b) block_done[b].store(0, std::memory_order_relaxed);
}

BakeState makeBakeState(std::size_t points, const DirectionTables& tables, int bounces) {
  BakeState state;
  state.points = points;
  state.blocks = (points + kBlockSize - 1) / kBlockSize;
  state.coefficients = tables.coefficients;
  state.row = 3 * rowStride(tables.coefficients);
  state.bounces = bounces;
  state.block_done = std::make_unique<std::atomic<std::uint8_t>[]>(state.blocks);
  state.direct.resize(points * std::size_t(tables.coefficients));
  state.sites.resize(points);
  if (bounces > 0) {
    state.bounce_tiles = std::size_t(tables.bounce_tiles);
    state.blocked.resize(points * state.bounce_tiles);
    state.previous.resize(points * state.row + kRowPadding);
    state.next.resize(points * state.row + kRowPadding);
    state.indirect.resize(points * state.row);
  }
  return state;
}

std::size_t bakeStateBytes(std::size_t points, const DirectionTables& tables, int bounces) {
  const std::size_t direct = sizeof(RaySite) + std::size_t(tables.coefficients) * sizeof(float);
  const std::size_t indirect = std::size_t(tables.bounce_tiles) * sizeof(std::uint16_t) +
                               9 * rowStride(tables.coefficients) * sizeof(float);
  return points * (direct + (bounces > 0 ? indirect : 0));
}

void Fingerprint::add(const void* bytes, std::size_t size) {
  const auto* from = static_cast<const unsigned char*>(bytes);
  while (size > 0) {
    std::uint64_t word = 0;
    const std::size_t taken = std::min<std::size_t>(size, sizeof word);
    std::memcpy(&word, from, taken);
    words[0] = (words[0] ^ word) * 0xff51afd7ed558ccdull;
    words[0] ^= words[0] >> 32;
    words[1] = (words[1] + word) * 0xc4ceb9fe1a85ec53ull;
    words[1] ^= words[1] >> 29;
    from += taken;
    size -= taken;
  }
}

namespace {

void addSlot(Fingerprint& print, const Scene& scene, const TextureSlot& slot) {
  print.addValue(slot.texture);
  if (!slot) return;
  print.addValue(slot.uv_set);
  print.addValue(slot.wrap_u);
  print.addValue(slot.wrap_v);
  print.addValue(slot.nearest);
  print.addValue(slot.texture_from_uv);
  const Texture& texture = scene.textures[std::size_t(slot.texture)];
  print.addValue(texture.width);
  print.addVector(texture.rgba);
}

void addMesh(Fingerprint& print, const Scene& scene, const Mesh& mesh) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  print.addValue(material.base_color);
  print.addValue(material.metallic);
  print.addValue(material.alpha_mask);
  print.addValue(material.alpha_cutoff);
  print.addValue(material.double_sided);
  addSlot(print, scene, material.base_color_map);
  addSlot(print, scene, material.metallic_roughness_map);
  print.addVector(mesh.colors);
  print.addValue(mesh.uv_sets.size());
  for (const auto& uv : mesh.uv_sets) print.addVector(uv);
}

}  // namespace

Fingerprint fingerprintOf(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                          const BakeOptions& options) {
  Fingerprint print;
  print.addValue(options.kind);
  print.addValue(options.order);
  print.addValue(options.kind == TransferKind::kInterreflected ? options.bounces : 0);
  print.addValue(options.directions);
  print.addValue(options.bounce_directions);
  const char* target = kernelTarget();
  print.add(target, std::strlen(target));
  print.addVector(points.positions);
  print.addVector(points.normals);
  print.addVector(points.triangles);
  print.addVector(points.facing);
  for (const Instance& instance : posed.instances) {
    if (!instance.deformed()) addMesh(print, scene, scene.meshes[std::size_t(instance.mesh)]);
  }
  return print;
}

}  // namespace gloam::prt
