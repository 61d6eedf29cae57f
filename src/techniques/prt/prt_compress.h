// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Clustered principal components of any vectors.
#pragma once

#include <gloam/error.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gloam::prt {

/// As CompressedTransfer has it.
struct ClusteredPca {
  std::vector<float> means, basis, weights;
  std::vector<std::uint16_t> cluster;
};

/// `values`: [point][number], `width` numbers each; `cluster_count` at most as many as there are points, at most 65536. `vectors`
/// at most `width`. Same bits for any number of threads. Throws Interrupted when asked to stop.
ClusteredPca clusteredPca(std::span<const float> values, std::size_t width, int cluster_count, int vectors,
                          int iterations, const Progress& progress = {});

}  // namespace gloam::prt
