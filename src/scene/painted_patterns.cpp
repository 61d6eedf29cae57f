// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/painted_patterns.h"

#include <algorithm>
#include <cmath>

#include "scene/painted_textures.h"

namespace gloam {
namespace {

float fraction(float x) {
  return x - std::floor(x);
}

/// Slow and fast unevenness about 1.
float mottle(float u, float v, float strength, std::uint32_t seed) {
  return 1.0f + strength * (0.7f * tilingNoise(8.0f * u, 8.0f * v, 8, seed) +
                            0.3f * tilingNoise(32.0f * u, 32.0f * v, 32, seed + 1));
}

/// 1 within, 0 outside of stripes at even places of x, their edges softened by `soft`.
float stripe(float x, float soft) {
  const float f = fraction(0.5f * x) * 2.0f;  // 0 to 1 is one stripe, 1 to 2 the next
  const float from_edge = f < 1.0f ? std::min(f, 1.0f - f) : -std::min(f - 1.0f, 2.0f - f);
  return smoothStep(-soft, soft, from_edge);
}

}  // namespace

int addPainted(SceneBuilder& builder, const std::string& name,
               const std::function<glm::vec3(float u, float v)>& albedo, int width, int height) {
  const int texture =
      builder.texture(paint(name, width, height, [&](float u, float v) { return stored(albedo(u, v)); }));
  const int material = builder.diffuse(name, glm::vec3(1.0f));
  builder.material(material).base_color_map.texture = texture;
  return material;
}

int addTiles(SceneBuilder& builder, const std::string& name, const glm::vec3& light, const glm::vec3& dark) {
  return addPainted(builder, name, [&](float u, float v) {
    const float x = 4.0f * u, y = 4.0f * v;
    const float fx = fraction(x), fy = fraction(y);
    const float edge = std::min(std::min(fx, 1.0f - fx), std::min(fy, 1.0f - fy));
    const int cx = int(x), cy = int(y);
    const float own = 1.0f + 0.08f * tilingNoise(float(cx * 7 + cy * 3) + 0.5f, 0.5f, 64, 5);
    const glm::vec3 tile = ((cx + cy) % 2 ? dark : light) * own * mottle(u, v, 0.05f, 9);
    return glm::mix(0.55f * tile, tile, smoothStep(0.012f, 0.045f, edge));
  });
}

int addBoards(SceneBuilder& builder, const std::string& name, const glm::vec3& wood) {
  return addPainted(builder, name, [&](float u, float v) {
    const float x = 4.0f * u, fx = fraction(x);
    const int board = int(x);
    const float own = 1.0f + 0.18f * tilingNoise(float(board) * 2.3f + 0.5f, 0.5f, 32, 3);
    const float grain =
        1.0f + 0.12f * tilingNoise(24.0f * u + 0.6f * tilingNoise(2 * u, 2 * v, 2, 12), 3.0f * v, 24, 4);
    return wood * own * grain * (0.45f + 0.55f * smoothStep(0.008f, 0.03f, std::min(fx, 1.0f - fx)));
  });
}

int addPlaster(SceneBuilder& builder, const std::string& name, const glm::vec3& tone, const glm::vec3& band,
               float band_from, float band_to) {
  return addPainted(builder, name, [&](float u, float v) {
    const float inside = smoothStep(band_from - 0.004f, band_from + 0.004f, v) *
                         (1.0f - smoothStep(band_to - 0.004f, band_to + 0.004f, v));
    return glm::mix(tone, band, inside) * mottle(u, v, 0.06f, 31);
  });
}

int addGores(SceneBuilder& builder, const std::string& name, const glm::vec3& a, const glm::vec3& b,
             const glm::vec3& pole, int gores) {
  return addPainted(builder, name, [&](float u, float v) {
    const glm::vec3 gore = glm::mix(a, b, stripe(u * float(gores), 0.03f));
    const float cap = 1.0f - smoothStep(0.085f, 0.1f, std::min(v, 1.0f - v));
    return glm::mix(gore, pole, cap);
  });
}

int addBelts(SceneBuilder& builder, const std::string& name, const glm::vec3& ground, const glm::vec3& belt,
             int belts) {
  return addPainted(builder, name, [&](float u, float v) {
    const float x = float(2 * belts + 1) * v;
    return glm::mix(ground, belt, 1.0f - stripe(x, 0.04f)) * mottle(u, v, 0.03f, 17);
  });
}

int addChequers(SceneBuilder& builder, const std::string& name, const glm::vec3& a, const glm::vec3& b,
                int nu, int nv) {
  return addPainted(builder, name, [&](float u, float v) {
    const float x = 2.0f * stripe(u * float(nu), 0.03f) - 1.0f,
                y = 2.0f * stripe(v * float(nv), 0.03f) - 1.0f;
    return glm::mix(a, b, 0.5f + 0.5f * x * y);
  });
}

}  // namespace gloam
