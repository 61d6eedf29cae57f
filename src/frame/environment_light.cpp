// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/environment_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "gpu/format.h"
#include "math/brdf.h"
#include "scene/environment.h"

namespace gloam::frame {

namespace {
constexpr float kLargestHalf = 65504.0f;
}

sh::ShRgb windowed(const sh::ShRgb& light, int order, Window window) {
  const sh::ShRgb bands = sh::truncated(light, order);
  switch (window) {
    case Window::kHann:
      return sh::windowHann(bands, float(order));
    case Window::kLanczos:
      return sh::windowLanczos(bands, float(order));
    case Window::kAuto:
      return sh::windowNonNegative(bands);
    default:
      return bands;
  }
}

namespace {

/// What the sharpest lobe shows is windowed, then unfolded again, so that any lobe's factors can be applied
/// to it.
sh::ShRgb lightForGloss(const sh::ShRgb& light) {
  const sh::Zh sharpest = brdf::phongZonal(sh::kMaxOrder, kSharpestGloss);
  sh::ShRgb gloss = windowed(sh::convolve(light, sharpest), sh::kMaxOrder, Window::kAuto);
  for (int l = 0; l < sh::kMaxOrder; ++l) {
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) gloss[i] /= brdf::phongBandFactor(l, kSharpestGloss);
  }
  return gloss;
}

/// Direction of a place of the octahedral map; places beyond -1 … 1 continue on the other side of the edge.
glm::vec3 octahedralDirection(glm::vec2 p) {
  if (std::abs(p.x) > 1.0f) p = {std::copysign(2.0f, p.x) - p.x, -p.y};
  if (std::abs(p.y) > 1.0f) p = {-p.x, std::copysign(2.0f, p.y) - p.y};
  const float z = 1.0f - std::abs(p.x) - std::abs(p.y);
  if (z >= 0.0f) return glm::normalize(glm::vec3(p, z));
  const glm::vec2 folded(std::copysign(1.0f - std::abs(p.y), p.x), std::copysign(1.0f - std::abs(p.x), p.y));
  return glm::normalize(glm::vec3(folded, z));
}

gpu::Image glossTable(gpu::Device& device, const sh::ShRgb& light) {
  constexpr int kSide = kGlossSize + 2;
  std::vector<float> texels;
  for (int slice = 0; slice < kGlossSlices; ++slice) {
    const float exponent = std::pow(kSharpestGloss, float(slice) / float(kGlossSlices - 1));
    const sh::ShRgb seen = sh::convolve(light, brdf::phongZonal(sh::kMaxOrder, exponent));
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const glm::vec2 place = (glm::vec2(x, y) - 0.5f) / float(kGlossSize) * 2.0f - 1.0f;
        const glm::vec3 radiance =
            glm::clamp(sh::valueAt(seen, octahedralDirection(place)), 0.0f, kLargestHalf);
        texels.insert(texels.end(), {radiance.r, radiance.g, radiance.b, 1.0f});
      }
    }
  }
  gpu::Image table(
      device, "frame.gloss",
      {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide, .depth = kGlossSlices});
  table.uploadFloats(texels);
  return table;
}

}  // namespace

EnvironmentLight::EnvironmentLight(gpu::Device& device, const Environment& environment)
    : sh_(projectEnvironment(environment, sh::kMaxOrder)) {
  static std::atomic<std::uint64_t> last_revision{0};
  revision_ = ++last_revision;
  gloss_ = glossTable(device, environment.empty() ? sh_ : lightForGloss(sh_));
  row_.cos_rotation = std::cos(environment.rotation_rad);
  row_.sin_rotation = std::sin(environment.rotation_rad);
  row_.intensity = environment.intensity;
  row_.map_width = float(environment.width);
  row_.map_height = float(environment.height);
  gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT, .mips = gpu::kAllMips};
  std::vector<std::uint16_t> halves(4, 0);
  if (!environment.empty()) {
    desc.width = environment.width;
    desc.height = environment.height;
    halves.resize(environment.radiance.size() * 4);
    for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        halves[4 * i + std::size_t(c)] =
            gpu::halfFromFloat(std::min(environment.radiance[i][c], kLargestHalf));
    }
  }
  map_ = gpu::Image(device, "frame.environment", desc);
  map_.upload(halves);
  map_.generateMips();
}

}  // namespace gloam::frame
