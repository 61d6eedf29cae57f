// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/texture_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gloam::reference {
namespace {

// IEC 61966-2-1, and bytes as they are.
std::array<float, 256> makeTable(bool srgb) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    const double decoded = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    table[std::size_t(i)] = float(srgb ? decoded : c);
  }
  return table;
}

const std::array<float, 256>& tableOf(bool srgb) {
  static const std::array<float, 256> as_is = makeTable(false), from_srgb = makeTable(true);
  return srgb ? from_srgb : as_is;
}

int wrapped(int texel, const TextureTable::Axis& axis) {
  const int size = axis.size;
  if (axis.wrap == Wrap::kClampToEdge) return std::clamp(texel, 0, size - 1);
  const int period = axis.wrap == Wrap::kRepeat ? size : 2 * size;
  const int in_period = texel < 0 ? texel + period : (texel >= period ? texel - period : texel);
  return in_period < size ? in_period : 2 * size - 1 - in_period;
}

struct Texels {
  int first, second;
  float rest;  // how far from the first to the second
};

// Brought into one period first: what is left is at most one texel beyond it.
Texels texelsAt(const TextureTable::Axis& axis, bool nearest, float given) {
  const float coordinate = std::abs(given) < 0x1p30f ? given : 0.0f;
  float in_period = std::clamp(coordinate, -1.0f, 2.0f);
  if (axis.wrap == Wrap::kRepeat) in_period = coordinate - std::floor(coordinate);
  if (axis.wrap == Wrap::kMirroredRepeat) in_period = coordinate - 2.0f * std::floor(coordinate * 0.5f);
  const float place = in_period * float(axis.size) - (nearest ? 0.0f : 0.5f);
  const float before = std::floor(place);
  const int first = int(before);
  return {wrapped(first, axis), wrapped(first + 1, axis), place - before};
}

}  // namespace

TextureReader::TextureReader(const Scene& scene, const TextureSlot& slot, const Mesh& mesh, bool srgb) {
  if (!slot) return;
  const Texture& texture = scene.textures[std::size_t(slot.texture)];
  if (texture.rgba.empty()) return;
  table_.texels = texture.rgba.data();
  table_.linear = tableOf(srgb).data();
  table_.srgb = srgb;
  table_.nearest = slot.nearest;
  table_.from_u = glm::vec2(slot.texture_from_uv[0]);
  table_.from_v = glm::vec2(slot.texture_from_uv[1]);
  table_.shift = glm::vec2(slot.texture_from_uv[2]);
  table_.across = {slot.wrap_u, texture.width};
  table_.down = {slot.wrap_v, texture.height};
  table_.placement = {{table_.from_u.x, table_.from_v.x, table_.shift.x},
                      float(texture.width),
                      {table_.from_u.y, table_.from_v.y, table_.shift.y},
                      float(texture.height),
                      float(slot.wrap_u),
                      float(slot.wrap_v),
                      slot.nearest ? 1.0f : 0.0f};
  const std::size_t set = std::size_t(slot.uv_set);
  if (set < mesh.uv_sets.size() && !mesh.uv_sets[set].empty()) uvs_ = mesh.uv_sets[set].data();
}

glm::vec4 TextureReader::read(const glm::vec2& uv) const {
  const glm::vec2 moved = table_.from_u * uv.x + table_.from_v * uv.y + table_.shift;
  const Texels x = texelsAt(table_.across, table_.nearest, moved.x),
               y = texelsAt(table_.down, table_.nearest, moved.y);
  const auto at = [&](int row, int column) {
    const std::uint8_t* c =
        table_.texels + (std::size_t(row) * std::size_t(table_.across.size) + std::size_t(column)) * 4;
    return glm::vec4(table_.linear[c[0]], table_.linear[c[1]], table_.linear[c[2]], float(c[3]) / 255.0f);
  };
  if (table_.nearest) return at(y.first, x.first);
  return glm::mix(glm::mix(at(y.first, x.first), at(y.first, x.second), x.rest),
                  glm::mix(at(y.second, x.first), at(y.second, x.second), x.rest), y.rest);
}

}  // namespace gloam::reference
