// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked transfer in less room: clustered principal component analysis (Sloan, Hall, Hart, Snyder 2003, "Clustered Principal
// Components for Precomputed Radiance Transfer"; PRT-9).
#pragma once

#include <gloam/scene.h>

#include <memory>
#include <span>

namespace gloam {

/// What the clusters of some meshes are: D numbers a mean and a vector.
struct TransferClusters {
  int clusters = 0;          ///< N, 1 to 65536
  int vectors = 0;           ///< M, 0 to D
  std::vector<float> means;  ///< [cluster][number]
  std::vector<float> basis;  ///< [cluster][vector][number]
  /// Bytes in a file, its floats or halves. Once, for all meshes that have the same.
  std::size_t bytes(bool half_float) const;
};

/// Diffuse transfer of a mesh's points, direct and indirect together: point p has D = n^2 numbers (n^2 + 3 n^2 with bounces),
/// those of Transfer::direct, then those of Transfer::indirect, and they are
///   mean of its cluster + sum over m of weights[p][m] * vector m of its cluster.
struct CompressedTransfer {
  std::shared_ptr<const TransferClusters>
      of;                              ///< never null; meshes that were compressed together have the same
  std::vector<float> weights;          ///< [point][vector]
  std::vector<std::uint16_t> cluster;  ///< [point]
  /// Bytes in a file, its floats or halves, without those of `of`.
  std::size_t bytes(bool half_float) const;
};

/// D of a transfer.
std::size_t numbersOfPoint(const Transfer& transfer);
/// Fills `direct` and `indirect` of a transfer whose order, bounces and compressed numbers are set and fit.
void expandTransfer(const CompressedTransfer& compressed, Transfer& transfer);

struct CompressOptions {
  int clusters =
      64;  ///< of all meshes together, 1 to 4096; fewer where they have less than 2 D points for each
  int vectors = 12;  ///< of a cluster, 1 to 144
  bool half_float =
      false;  ///< numbers are rounded as a file of halves rounds them, and errors are those after it
  int iterations = 12;  ///< of points changing their cluster, at most
};

/// Over all meshes. Errors are root mean squares, relative to what they are errors of.
struct CompressReport {
  std::size_t points = 0, bytes_before = 0, bytes = 0;  ///< before: in the same format
  double transfer_error = 0.0;                          ///< of all numbers of the transfer
  double worst_light_error = 0.0, light_error = 0.0;    ///< of irradiance under the test lights: worst, mean
  std::string worst_light;
};
/// The lights that irradiance is tried under.
std::span<const char* const> compressionTestLights();

/// Compresses the diffuse transfer of all meshes, in clusters that they share where they have as many numbers a point; their
/// numbers become what the compressed ones expand to. Same bits for any number of threads. Throws Error for options out of range and where no mesh carries transfer,
/// Interrupted when asked to stop.
Scene compressTransfer(const Scene& scene, const CompressOptions& options, const Progress& progress = {},
                       CompressReport* report = nullptr);

}  // namespace gloam
