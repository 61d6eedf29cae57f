// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8: exponentials by series (PS), optimal linear (OL) and hybrid (HYB) as in Ren et al. 2006, and one that is not in
// the paper: HYB on an optimal quadratic, without HYB's jumps. exp(f^) = exp(f^ / 2^p)^(2^p), so f is scaled down until a fit of few
// coefficients holds, then squared. The mean goes through the squarings too (exp(mean / 2^p) before them), which keeps
// all numbers near 1 where exp(f^) alone would overflow and exp(mean) vanish. Coefficients: sh_exp_fit.cpp.
#include <fmt/format.h>

#include <cmath>

#include "math/sh_check.h"
#include "math/sh_constants.h"
#include "math/sh_exp_core.h"
#include "math/sh_log_exp.h"

namespace gloam::sh {
namespace {

const float kSqrt4Pi = kShZonal0;

/// f without its mean; `mean` is f_0 / sqrt(4 pi).
struct Isolated {
  Sh rest;
  float mean = 0.0f, norm = 0.0f;

  explicit Isolated(const Sh& f) : rest(f), mean(f[0] / kSqrt4Pi) {
    rest[0] = 0.0f;
    float sum = 0.0f;
    for (int i = 1; i < f.size(); ++i) sum += f[i] * f[i];
    norm = std::sqrt(sum);
  }
};

Sh constant(int order, float value) {
  Sh one(order);
  one[0] = value * kSqrt4Pi;
  return one;
}

/// a 1 + b f^ + c f^ * f^, times `mean`; x = |f^|.
Sh coreAt(const ExpCore& core, const Sh& f, float x, float mean) {
  Sh h = core.quadratic ? square(f) : Sh(f.order);
  h *= mean * core.c(x);
  Sh linear = f;
  linear *= mean * core.b(x);
  h += linear;
  h[0] += mean * core.a(x) * kSqrt4Pi;
  return h;
}

Sh scaleAndSquare(const Sh& f, ExpCore (*coreOf)(int order)) {
  checkOrder(f.order);
  const Isolated isolated(f);
  if (f.order == 1) return constant(1, std::exp(isolated.mean));
  const ExpCore core = coreOf(f.order);
  const float shortening = expShortening(isolated.norm);
  const int squarings = expSquarings(isolated.norm * shortening, core.range);
  const float scale = std::ldexp(shortening, -squarings), x = isolated.norm * scale;
  const float mean = std::exp(isolated.mean * scale);
  Sh scaled = isolated.rest;
  scaled *= scale;
  Sh h = coreAt(core, scaled, x, mean);
  if (const float blend = core.quadratic ? expBlend(x, core.range) : 0.0f; blend > 0.0f) {
    scaled *= 0.5f;
    Sh halved = square(coreAt(core, scaled, 0.5f * x, std::sqrt(mean)));
    h *= 1.0f - blend;
    halved *= blend;
    h += halved;
  }
  for (int i = 0; i < squarings; ++i) h = square(h);
  return h;
}

}  // namespace

ExpCore hybridCore(int order) {
  static constexpr const float* kCores[] = {kShExpHybrid2, kShExpHybrid3, kShExpHybrid4, kShExpHybrid5,
                                            kShExpHybrid6};
  const float* t = kCores[order - 2];
  return {false, t[0], t[1], t[2], t[3], t[4]};
}

ExpCore quadraticCore(int order) {
  static constexpr const float* kCores[] = {kShExpQuadratic2, kShExpQuadratic3, kShExpQuadratic4,
                                            kShExpQuadratic5, kShExpQuadratic6};
  const float* t = kCores[order - 2];
  return {true, t[0], t[1], t[2], t[3], t[4], t[5], t[6]};
}

Sh expSeries(const Sh& f, int terms) {
  checkOrder(f.order);
  if (terms < 1)
    throw Error("spherical harmonics", fmt::format("exponential by {} terms, expected at least 1", terms));
  const Isolated isolated(f);
  const float mean = std::exp(isolated.mean);
  Sh term = isolated.rest, sum = constant(f.order, 1.0f);
  sum += term;
  for (int n = 2; n <= terms; ++n) {
    term = product(term, isolated.rest);
    term *= 1.0f / static_cast<float>(n);
    sum += term;
  }
  sum *= mean;
  return sum;
}

Sh expLinear(const Sh& f) {
  checkOrder(f.order);
  const Isolated isolated(f);
  const float mean = std::exp(isolated.mean);
  if (f.order == 1) return constant(1, mean);
  static constexpr const float* kA[] = {kShExpLinearA2, kShExpLinearA3, kShExpLinearA4, kShExpLinearA5,
                                        kShExpLinearA6};
  static constexpr const float* kB[] = {kShExpLinearB2, kShExpLinearB3, kShExpLinearB4, kShExpLinearB5,
                                        kShExpLinearB6};
  const float place = std::min(isolated.norm / kShExpLinearStep, float(kShExpLinearEntries - 1));
  const int below = std::min(static_cast<int>(place), kShExpLinearEntries - 2);
  const float t = place - static_cast<float>(below);
  const float *a = kA[f.order - 2] + below, *b = kB[f.order - 2] + below;
  Sh h = isolated.rest;
  h *= mean * (b[0] + t * (b[1] - b[0]));
  h[0] = mean * (a[0] + t * (a[1] - a[0])) * kSqrt4Pi;
  return h;
}

Sh expHybrid(const Sh& f) {
  return scaleAndSquare(f, hybridCore);
}

Sh expQuadratic(const Sh& f) {
  return scaleAndSquare(f, quadraticCore);
}

Sh exponential(const Sh& f, ExpMethod method) {
  switch (method) {
    case ExpMethod::kSeries:
      return expSeries(f);
    case ExpMethod::kLinear:
      return expLinear(f);
    case ExpMethod::kQuadratic:
      return expQuadratic(f);
    case ExpMethod::kHybrid:
      break;
  }
  return expHybrid(f);
}

}  // namespace gloam::sh
