// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/environment_light.h"

#include <algorithm>
#include <cmath>

#include "math/brdf.h"
#include "scene/environment.h"

namespace gloam::frame {

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

/// What the sharpest lobe shows is windowed, then unfolded again, so that shaders apply any lobe's factors to it.
sh::ShRgb lightForGloss(const sh::ShRgb& light) {
  const sh::Zh sharpest = brdf::phongZonal(sh::kMaxOrder, kSharpestGloss);
  sh::ShRgb gloss = windowed(sh::convolve(light, sharpest), sh::kMaxOrder, Window::kAuto);
  for (int l = 0; l < sh::kMaxOrder; ++l) {
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) gloss[i] /= brdf::phongBandFactor(l, kSharpestGloss);
  }
  return gloss;
}

}  // namespace

EnvironmentLight::EnvironmentLight(gpu::Device& device, const Environment& environment)
    : sh_(projectEnvironment(environment, sh::kMaxOrder)) {
  const sh::ShRgb gloss = lightForGloss(sh_);
  for (int i = 0; i < kShLightCoefficients; ++i) row_.sh[i] = gloss[i];
  row_.cos_rotation = std::cos(environment.rotation_rad);
  row_.sin_rotation = std::sin(environment.rotation_rad);
  row_.intensity = environment.intensity;
  row_.map_width = float(environment.width);
  row_.map_height = float(environment.height);
  gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT, .mips = gpu::kAllMips};
  std::vector<float> texels(4, 0.0f);
  if (!environment.empty()) {
    desc.width = environment.width;
    desc.height = environment.height;
    texels.resize(environment.radiance.size() * 4);
    for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        texels[4 * i + std::size_t(c)] = std::min(environment.radiance[i][c], 65504.0f);
    }
  }
  map_ = gpu::Image(device, "frame.environment", desc);
  map_.uploadFloats(texels);
  map_.generateMips();
}

}  // namespace gloam::frame
