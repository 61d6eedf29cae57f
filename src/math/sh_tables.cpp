// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-6: the tripling tensor (Sloan, Kautz, Snyder 2002; Snyder 2006), exact and sparse, evaluated by the compiler.
#include "math/sh_tables.h"

#include <cmath>

namespace gloam::sh::tables {
namespace {

constexpr int bandOf(int i) {
  int l = 0;
  while ((l + 1) * (l + 1) <= i) ++l;
  return l;
}

constexpr std::array<exact::PolarPart, kMaxCoefficients> makePolarParts() {
  std::array<exact::PolarPart, kMaxCoefficients> parts{};
  for (int i = 0; i < kMaxCoefficients; ++i) {
    const int l = bandOf(i);
    parts[static_cast<std::size_t>(i)] = exact::polarPart(l, i - l * (l + 1));
  }
  return parts;
}
constexpr std::array<exact::PolarPart, kMaxCoefficients> kPolarParts = makePolarParts();

constexpr double exactGamma(std::size_t i, std::size_t j, std::size_t k) {
  const double value = exact::tripleIntegral(kPolarParts[i], kPolarParts[j], kPolarParts[k]);
  return value < 1e-12 && value > -1e-12 ? 0.0 : value;  // the least true entry is 0.0096
}

struct Triples {
  std::array<GammaTriple, 600> triples{};
  std::array<std::size_t, kMaxOrder + 1> count{};  // [order]: a lower order's stand before a higher one's
};

constexpr Triples makeTriples() {
  Triples made;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kMaxCoefficients; ++k) {
    for (std::size_t j = 0; j <= k; ++j)
      for (std::size_t i = 0; i <= j; ++i) {
        const double value = exactGamma(i, j, k);
        if (value == 0.0) continue;
        made.triples[count++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j),
                                 static_cast<std::uint8_t>(k), static_cast<float>(value)};
      }
    made.count[static_cast<std::size_t>(bandOf(static_cast<int>(k)) + 1)] = count;
  }
  return made;
}
constexpr Triples kTriples = makeTriples();

ProductPlan makePlan(int order) {
  ProductPlan plan;
  const int size = coefficientCount(order);
  for (int k = 0; k < size; ++k)
    for (int j = 0; j <= k; ++j) {
      const std::size_t before = plan.entries.size();
      for (int i = 0; i < size; ++i)
        if (const float value = gamma(i, j, k); value != 0.0f)
          plan.entries.push_back({static_cast<std::uint32_t>(i), value});
      const std::size_t count = plan.entries.size() - before;
      if (count > 0)
        plan.pairs.push_back(
            {static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(count)});
    }
  return plan;
}

}  // namespace

std::span<const GammaTriple> gammaTriples(int order) {
  return {kTriples.triples.data(), kTriples.count[static_cast<std::size_t>(order)]};
}

const ProductPlan& productPlan(int order) {
  static const std::array<ProductPlan, kMaxOrder> plans = {makePlan(1), makePlan(2), makePlan(3),
                                                           makePlan(4), makePlan(5), makePlan(6)};
  return plans[static_cast<std::size_t>(order - 1)];
}

}  // namespace gloam::sh::tables
