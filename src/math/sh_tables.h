// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-3, SH-6: the tables that products and rotations use, made by the compiler from exact integrals (sh_exact.h): none
// is typed in, none is sampled.
#pragma once

#include <gloam/sh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/sh_exact.h"

namespace gloam::sh::tables {

/// Gamma_ijk = integral of y_i y_j y_k, the same for all permutations; here i <= j <= k.
struct GammaTriple {
  std::uint8_t i, j, k;
  float value;
};
/// All non-zero triples of that order.
std::span<const GammaTriple> gammaTriples(int order);

/// A product f_j g_k + f_k g_j (f_j g_j where j = k) and how many coefficients it feeds.
struct ProductPair {
  std::uint8_t j, k, count;
};
struct ProductEntry {
  std::uint32_t i;
  float gamma;
};
/// Gamma of one order as products run through it: each pair with its entries, which follow one another.
struct ProductPlan {
  std::vector<ProductPair> pairs;
  std::vector<ProductEntry> entries;
};
const ProductPlan& productPlan(int order);

/// J_l, the matrix of the exchange (x, y, z) -> (x, z, y) in band l: symmetric, its own inverse, three quarters zero.
/// Row and column are m + l.
using ExchangeBand = std::array<std::array<float, 2 * kMaxOrder - 1>, 2 * kMaxOrder - 1>;

constexpr std::array<ExchangeBand, kMaxOrder> makeExchange() {
  std::array<ExchangeBand, kMaxOrder> bands{};
  for (int l = 0; l < kMaxOrder; ++l)
    for (int row = 0; row <= 2 * l; ++row)
      for (int column = 0; column <= row; ++column) {
        const auto band = static_cast<std::size_t>(l), r = static_cast<std::size_t>(row),
                   c = static_cast<std::size_t>(column);
        bands[band][r][c] = bands[band][c][r] =
            static_cast<float>(exact::exchangeIntegral(l, row - l, column - l));
      }
  return bands;
}
inline constexpr std::array<ExchangeBand, kMaxOrder> kExchange = makeExchange();

}  // namespace gloam::sh::tables
