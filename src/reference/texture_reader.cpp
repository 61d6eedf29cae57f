// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/texture_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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

using Four = float __attribute__((vector_size(16)));

Four texel(const std::uint8_t* c, const float* linear) {
  return Four{linear[c[0]], linear[c[1]], linear[c[2]], float(c[3]) * (1.0f / 255.0f)};
}

}  // namespace

TextureReader::TextureReader(const Scene& scene, const TextureSlot& slot, const Mesh& mesh, bool srgb) {
  if (!slot) return;
  const Texture& texture = scene.textures[std::size_t(slot.texture)];
  if (texture.rgba.empty()) return;
  texels_ = texture.rgba.data();
  linear_ = tableOf(srgb).data();
  const std::size_t set = std::size_t(slot.uv_set);
  if (set < mesh.uv_sets.size() && !mesh.uv_sets[set].empty()) uvs_ = mesh.uv_sets[set].data();
  column_u_ = glm::vec2(slot.texture_from_uv[0]);
  column_v_ = glm::vec2(slot.texture_from_uv[1]);
  shift_ = glm::vec2(slot.texture_from_uv[2]);
  across_ = {slot.wrap_u, texture.width};
  down_ = {slot.wrap_v, texture.height};
  nearest_ = slot.nearest;
}

int TextureReader::Axis::wrapped(int texel) const {
  if (wrap == Wrap::kClampToEdge) return std::clamp(texel, 0, size - 1);
  if (wrap == Wrap::kRepeat) return texel < 0 ? texel + size : (texel >= size ? texel - size : texel);
  const int in_period = texel < 0 ? texel + 2 * size : (texel >= 2 * size ? texel - 2 * size : texel);
  return in_period < size ? in_period : 2 * size - 1 - in_period;
}

// Brought into one period first: what is left is at most one texel beyond it.
TextureReader::Axis::Pair TextureReader::Axis::at(float coordinate, bool nearest) const {
  float in_period = 0.0f;
  if (!std::isfinite(coordinate)) {
    in_period = 0.0f;
  } else if (wrap == Wrap::kRepeat) {
    in_period = coordinate - std::floor(coordinate);
  } else if (wrap == Wrap::kMirroredRepeat) {
    in_period = coordinate - 2.0f * std::floor(coordinate * 0.5f);
  } else {
    in_period = std::clamp(coordinate, -1.0f, 2.0f);
  }
  const float place = in_period * float(size) - (nearest ? 0.0f : 0.5f);
  const float before = std::floor(place);
  const int first = int(before);
  return {wrapped(first), nearest ? 0 : wrapped(first + 1), place - before};
}

glm::vec4 TextureReader::read(const glm::uvec3& corners, float u, float v) const {
  glm::vec2 uv(0.0f);
  if (uvs_) uv = uvs_[corners.x] * (1.0f - u - v) + uvs_[corners.y] * u + uvs_[corners.z] * v;
  const glm::vec2 moved = column_u_ * uv.x + column_v_ * uv.y + shift_;
  const Axis::Pair x = across_.at(moved.x, nearest_), y = down_.at(moved.y, nearest_);
  const auto row = [&](int which) { return texels_ + std::size_t(which) * std::size_t(across_.size) * 4; };
  const auto at = [&](const std::uint8_t* of_row, int column) {
    return texel(of_row + std::size_t(column) * 4, linear_);
  };
  const std::uint8_t* upper = row(y.first);
  Four result = at(upper, x.first);
  if (!nearest_) {
    const std::uint8_t* lower = row(y.second);
    result += (at(upper, x.second) - result) * x.rest;
    const Four below_left = at(lower, x.first);
    const Four below = below_left + (at(lower, x.second) - below_left) * x.rest;
    result += (below - result) * y.rest;
  }
  glm::vec4 read;
  std::memcpy(&read, &result, sizeof read);
  return read;
}

}  // namespace gloam::reference
