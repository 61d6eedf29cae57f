// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/environment_light.h"

#include <array>
#include <atomic>
#include <cmath>

#include "math/brdf.h"
#include "scene/environment.h"

namespace gloam::frame {

namespace {
constexpr float kLargestHalf = 65504.0f;
constexpr int kGlossSide = kGlossSize + 2;
}  // namespace

Window windowNamed(const std::string& name) {
  if (name == "hann") return Window::kHann;
  if (name == "lanczos") return Window::kLanczos;
  return name == "auto" ? Window::kAuto : Window::kNone;
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

/// The basis at each texel of a slice.
const std::vector<sh::Sh>& glossBasis() {
  static const std::vector<sh::Sh> basis = [] {
    std::vector<sh::Sh> rows;
    for (int y = 0; y < kGlossSide; ++y) {
      for (int x = 0; x < kGlossSide; ++x) {
        const glm::vec2 place = (glm::vec2(x, y) - 0.5f) / float(kGlossSize) * 2.0f - 1.0f;
        rows.push_back(sh::evaluate(sh::kMaxOrder, octahedralDirection(place)));
      }
    }
    return rows;
  }();
  return basis;
}

/// Slices differ by the factors of bands alone.
std::vector<float> glossTexels(const sh::ShRgb& light) {
  const std::vector<sh::Sh>& basis = glossBasis();
  std::array<std::array<float, sh::kMaxOrder>, kGlossSlices> factors;
  for (int slice = 0; slice < kGlossSlices; ++slice) {
    const float exponent = std::pow(kSharpestGloss, float(slice) / float(kGlossSlices - 1));
    for (int l = 0; l < sh::kMaxOrder; ++l)
      factors[std::size_t(slice)][std::size_t(l)] = brdf::phongBandFactor(l, exponent);
  }
  std::vector<float> texels(basis.size() * kGlossSlices * 4, 1.0f);
  for (std::size_t t = 0; t < basis.size(); ++t) {
    std::array<glm::vec3, sh::kMaxOrder> bands{};
    for (int l = 0; l < sh::kMaxOrder; ++l) {
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) bands[std::size_t(l)] += basis[t][i] * light[i];
    }
    for (std::size_t slice = 0; slice < kGlossSlices; ++slice) {
      glm::vec3 sum(0.0f);
      for (std::size_t l = 0; l < bands.size(); ++l) sum += factors[slice][l] * bands[l];
      const glm::vec3 radiance = glm::clamp(sum, 0.0f, kLargestHalf);
      for (int c = 0; c < 3; ++c) texels[4 * (slice * basis.size() + t) + std::size_t(c)] = radiance[c];
    }
  }
  return texels;
}

}  // namespace

EnvironmentLight::EnvironmentLight(gpu::Device& device, const Environment& environment)
    : picture_(device),
      gloss_(device, "frame.gloss",
             {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
              .width = kGlossSide,
              .height = kGlossSide,
              .depth = kGlossSlices}) {
  gloss_.uploadFloats(std::vector<float>(std::size_t(kGlossSide) * kGlossSide * kGlossSlices * 4, 0.0f));
  set(environment);
}

void EnvironmentLight::set(const Environment& environment) {
  static std::atomic<std::uint64_t> last_revision{0};
  picture_.set(environment);
  sh_ = projectEnvironment(environment, sh::kMaxOrder);
  revision_ = ++last_revision;
}

const gpu::Image& EnvironmentLight::gloss() const {
  if (gloss_revision_ != revision_) gloss_.uploadFloats(glossTexels(empty() ? sh_ : lightForGloss(sh_)));
  gloss_revision_ = revision_;
  return gloss_;
}

}  // namespace gloam::frame
