// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan et al. 2007, section 4.1, "Coverage Oracle" and "Smooth Clamping". The paper takes the worst light (a delta) for
// fixed factors of 15 and 10 and proposes the actual light; here both.
#include "techniques/proxies/proxies_coverage.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/sh_log_exp.h"
#include "techniques/proxies/proxies_tables.h"

namespace gloam::proxies {

namespace {

constexpr int kDirections = 96;
constexpr float kLeastReach = 1.5f, kMostReach = 30.0f;

/// What a zonal blocker turned to a direction takes from a receiver: sum over bands of g_l times these.
struct Loss {
  glm::vec3 band[kShadowOrder];
};

float brightest(const glm::vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

glm::vec3 shadeTerm(const ProxyLight& light, int i, const glm::vec3& way, const sh::Sh& normal) {
  glm::vec3 sum =
      light.peak.irradiance * light.peak.basis[i] * std::max(0.0f, glm::dot(way, light.peak.direction));
  for (int j = 0; j < 9; ++j) sum += light.shade[9 * i + j] * normal[j];
  return sum;
}

std::vector<Loss> losses(const ProxyLight& light, const std::vector<glm::vec3>& ways) {
  std::vector<Loss> result;
  for (const glm::vec3& n : ways) {
    const sh::Sh normal = sh::evaluate(kIndirectOrder, n);
    glm::vec3 terms[16];
    for (int i = 0; i < 16; ++i) terms[i] = shadeTerm(light, i, n, normal);
    for (const glm::vec3& d : ways) {
      if (glm::dot(d, n) < 0.0f) continue;
      const sh::Sh y = sh::evaluate(kShadowOrder, d);
      Loss loss{};
      for (int l = 0; l < kShadowOrder; ++l) {
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) loss.band[l] += sh::zonalFactor(l) * y[i] * terms[i];
      }
      result.push_back(loss);
    }
  }
  return result;
}

/// Greatest sine of a half-angle at which `change` (which grows with it) is within the tolerance.
template <class Change>
float greatestSine(float tolerance, const Change& change) {
  float low = 1.0f / kMostReach, high = 1.0f / kLeastReach;
  for (int i = 0; i < 12; ++i) {
    const float middle = 0.5f * (low + high);
    (change(middle) <= tolerance ? low : high) = middle;
  }
  return low;
}

}  // namespace

Reach reachOf(const ProxyLight& light, float tolerance) {
  const std::vector<glm::vec3> ways = sampling::fibonacciSphere(kDirections);
  float most = 0.0f;  // irradiance without proxies: O = 1
  for (const glm::vec3& n : ways)
    most = std::max(most,
                    brightest(shadeTerm(light, 0, n, sh::evaluate(kIndirectOrder, n))) * sh::zonalFactor(0));
  if (!(most > 0.0f)) return kFixedReach;
  const std::vector<Loss> all = losses(light, ways);
  Reach reach;
  reach.shadow = 1.0f / greatestSine(tolerance, [&](float sine) {
                   const sh::Zh disc = sh::discZonal(kShadowOrder, std::asin(sine));
                   float greatest = 0.0f;
                   for (const Loss& loss : all)
                     greatest =
                         std::max(greatest, brightest(disc[0] * loss.band[0] + disc[1] * loss.band[1] +
                                                      disc[2] * loss.band[2] + disc[3] * loss.band[3]));
                   return greatest / most;
                 });
  const sh::Zh cosine = sh::clampedCosine(kIndirectOrder);
  reach.indirect = 1.0f / greatestSine(tolerance, [&](float sine) {
                     const sh::Zh disc = sh::discZonal(kIndirectOrder, std::asin(sine)),
                                  mean = averageOperatorFit(sine);
                     const float on_plane = disc[0] * cosine[0] + disc[1] * cosine[1] + disc[2] * cosine[2];
                     float greatest = 0.0f;
                     for (const glm::vec3& d : ways) {
                       const sh::Sh turned = sh::rotateZonal(mean, d);
                       glm::vec3 radiance(0.0f);
                       for (int i = 0; i < 9; ++i) radiance += turned[i] * light.leaving[i];
                       greatest = std::max(greatest, brightest(radiance) * on_plane);
                     }
                     return greatest / most;
                   });
  return {std::min(reach.shadow, kFixedReach.shadow), std::min(reach.indirect, kFixedReach.indirect)};
}

Fade fadeOf(float reach) {
  const float step = 1.0f / float(kLogEntries - 1);
  const float middle = sh::logBlockerCoordinate(1.0f / reach);
  return {middle - 2.0f * step, middle + 2.0f * step};
}

}  // namespace gloam::proxies
