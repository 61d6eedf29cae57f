// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Clustered principal components back to numbers of each point (Sloan, Hall, Hart, Snyder 2003, equation 7).
#include <gloam/compress.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace gloam {

std::size_t TransferClusters::bytes(bool half_float) const {
  return (means.size() + basis.size()) * (half_float ? 2 : 4);
}

std::size_t CompressedTransfer::bytes(bool half_float) const {
  return weights.size() * (half_float ? 2 : 4) + cluster.size() * (of->clusters <= 256 ? 1 : 2);
}

std::size_t numbersOfPoint(const Transfer& transfer) {
  const auto direct = std::size_t(transfer.order * transfer.order);
  const bool bounces = transfer.compressed ? transfer.bounces > 0 : !transfer.indirect.empty();
  return bounces ? 4 * direct : direct;
}

void expandTransfer(const CompressedTransfer& compressed, Transfer& transfer) {
  const auto direct = std::size_t(transfer.order * transfer.order);
  const TransferClusters& of = *compressed.of;
  const std::size_t width = of.means.size() / std::size_t(of.clusters);
  const auto vectors = std::size_t(of.vectors);
  const std::size_t points = compressed.cluster.size(), indirect = width - direct;
  transfer.direct.resize(points * direct);
  transfer.indirect.resize(points * indirect);
  constexpr std::size_t kBlock = 1024;
  tbb::parallel_for(std::size_t(0), (points + kBlock - 1) / kBlock, [&](std::size_t block) {
    std::vector<float> sum(width);
    for (std::size_t p = block * kBlock; p < std::min(points, (block + 1) * kBlock); ++p) {
      const std::size_t c = compressed.cluster[p];
      std::copy_n(&of.means[c * width], width, sum.begin());
      for (std::size_t m = 0; m < vectors; ++m) {
        const float weight = compressed.weights[p * vectors + m];
        const float* vector = &of.basis[(c * vectors + m) * width];
        for (std::size_t i = 0; i < width; ++i) sum[i] += weight * vector[i];
      }
      std::copy_n(sum.begin(), direct, &transfer.direct[p * direct]);
      if (indirect > 0)
        std::copy_n(sum.begin() + std::ptrdiff_t(direct), indirect, &transfer.indirect[p * indirect]);
    }
  });
}

}  // namespace gloam
