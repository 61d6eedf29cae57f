// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Hall, Hart, Snyder 2003, section 4: points are clustered so that each cluster lies near an affine space of M
// dimensions. From a k-means start, in turns: principal components of each cluster (eigenvectors of its covariance), then each
// point goes to the cluster whose space it is nearest to, |x - mean|^2 - |B (x - mean)|^2. Differs from the paper: direct and
// indirect light are one vector, so that a point has one cluster and one set of weights (measured in README.md); the direct
// numbers count three times, as each of the three colours is lit by them.
#include <gloam/compress.h>
#include <gloam/lights.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "techniques/prt/prt_compress.h"

namespace gloam {
namespace prt {
namespace {

using Index = Eigen::Index;
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Points = Eigen::Map<const Rows>;
constexpr Index kBlock = 512;  // points that are looked at together
constexpr int kMeanIterations = 6;

struct Clusters {
  Rows means;               // [cluster][number]
  std::vector<Rows> basis;  // [cluster], [vector][number]
  std::vector<std::uint16_t> of;
  std::vector<float> error;  // squared, of each point
};

/// Calls work(first, count) for blocks of points on all cores.
template <class Work>
void forBlocks(Index points, const Work& work) {
  tbb::parallel_for(Index(0), (points + kBlock - 1) / kBlock,
                    [&](Index b) { work(b * kBlock, std::min(kBlock, points - b * kBlock)); });
}

/// Each point goes to the nearest space. Returns how many changed.
std::size_t assign(const Points& points, Clusters& clusters) {
  std::vector<std::size_t> changed(std::size_t((points.rows() + kBlock - 1) / kBlock), 0);
  forBlocks(points.rows(), [&](Index first, Index count) {
    Eigen::VectorXf best = Eigen::VectorXf::Constant(count, std::numeric_limits<float>::infinity());
    std::vector<std::uint16_t> nearest(std::size_t(count), 0);
    Rows off(count, points.cols()), along;
    for (Index c = 0; c < clusters.means.rows(); ++c) {
      off = points.middleRows(first, count).rowwise() - clusters.means.row(c);
      Eigen::VectorXf distance = off.rowwise().squaredNorm();
      const Rows& basis = clusters.basis[std::size_t(c)];
      if (basis.rows() > 0) {
        along.noalias() = off * basis.transpose();
        distance -= along.rowwise().squaredNorm();
      }
      for (Index i = 0; i < count; ++i) {
        if (distance[i] < best[i]) {
          best[i] = distance[i];
          nearest[std::size_t(i)] = std::uint16_t(c);
        }
      }
    }
    for (Index i = 0; i < count; ++i) {
      const auto p = std::size_t(first + i);
      changed[std::size_t(first / kBlock)] += clusters.of[p] != nearest[std::size_t(i)];
      clusters.of[p] = nearest[std::size_t(i)];
      clusters.error[p] = std::max(0.0f, best[i]);
    }
  });
  std::size_t sum = 0;
  for (const std::size_t n : changed) sum += n;
  return sum;
}

/// An empty cluster begins anew at the point that is shown worst.
void seedEmpty(const Points& points, Clusters& clusters, std::vector<std::vector<Index>>& members) {
  for (std::size_t c = 0; c < members.size(); ++c) {
    if (!members[c].empty()) continue;
    const auto worst = std::size_t(std::ranges::max_element(clusters.error) - clusters.error.begin());
    clusters.error[worst] = 0.0f;
    clusters.means.row(Index(c)) = points.row(Index(worst));
  }
}

/// Means and, where `vectors` > 0, principal components of every cluster. A cluster sums its members in order, so that the
/// number of threads does not matter.
void fit(const Points& points, int vectors, Clusters& clusters) {
  std::vector<std::vector<Index>> members(std::size_t(clusters.means.rows()));
  for (std::size_t p = 0; p < clusters.of.size(); ++p) members[clusters.of[p]].push_back(Index(p));
  tbb::parallel_for(std::size_t(0), members.size(), [&](std::size_t c) {
    if (members[c].empty()) return;
    const Index width = points.cols();
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(width);
    for (const Index p : members[c]) mean += points.row(p).transpose().cast<double>();
    mean /= double(members[c].size());
    clusters.means.row(Index(c)) = mean.transpose().cast<float>();
    if (vectors == 0) return;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(width, width);
    Rows off;
    for (std::size_t first = 0; first < members[c].size(); first += std::size_t(kBlock)) {
      const Index count = Index(std::min(std::size_t(kBlock), members[c].size() - first));
      off.resize(count, width);
      for (Index i = 0; i < count; ++i)
        off.row(i) = points.row(members[c][first + std::size_t(i)]) - clusters.means.row(Index(c));
      const Eigen::MatrixXf block = off.transpose() * off;
      covariance += block.cast<double>();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    const Index kept = std::min<Index>(vectors, width);  // eigenvalues ascend
    clusters.basis[c] = solver.eigenvectors().rightCols(kept).rowwise().reverse().transpose().cast<float>();
  });
  seedEmpty(points, clusters, members);
}

}  // namespace

ClusteredPca clusteredPca(std::span<const float> values, std::size_t width, int cluster_count, int vectors,
                          int iterations, const Progress& progress) {
  const Index rows = Index(values.size() / width);
  const Points points(values.data(), rows, Index(width));
  Clusters clusters;
  clusters.means.resize(cluster_count, Index(width));
  clusters.basis.assign(std::size_t(cluster_count), Rows(0, Index(width)));
  clusters.of.assign(std::size_t(rows), 0);
  clusters.error.assign(std::size_t(rows), 0.0f);
  for (Index c = 0; c < cluster_count; ++c)  // neighbours in a file are neighbours in space, mostly
    clusters.means.row(c) = points.row((2 * c + 1) * rows / (2 * cluster_count));
  const int steps = kMeanIterations + iterations;
  for (int step = 0; step < steps; ++step) {
    if (progress.stopRequested()) throw Interrupted("interrupted while the transfer was compressed");
    progress.report(double(step) / double(steps + 1), "principal components");
    const std::size_t changed = assign(points, clusters);
    fit(points, step < kMeanIterations ? 0 : vectors, clusters);
    if (step > kMeanIterations && changed * 1000 < std::size_t(rows)) break;
  }
  assign(points, clusters);
  ClusteredPca result;
  result.cluster = std::move(clusters.of);
  result.means.assign(clusters.means.data(), clusters.means.data() + clusters.means.size());
  result.basis.assign(std::size_t(cluster_count) * std::size_t(vectors) * width, 0.0f);
  result.weights.assign(std::size_t(rows) * std::size_t(vectors), 0.0f);
  for (std::size_t c = 0; c < std::size_t(cluster_count); ++c)
    std::copy_n(clusters.basis[c].data(), clusters.basis[c].size(),
                &result.basis[c * std::size_t(vectors) * width]);
  forBlocks(rows, [&](Index first, Index count) {
    for (Index p = first; p < first + count; ++p) {
      const Rows& basis = clusters.basis[result.cluster[std::size_t(p)]];
      if (basis.rows() == 0) continue;
      const Eigen::VectorXf weights =
          basis * (points.row(p) - clusters.means.row(result.cluster[std::size_t(p)])).transpose();
      std::copy_n(weights.data(), weights.size(), &result.weights[std::size_t(p) * std::size_t(vectors)]);
    }
  });
  return result;
}

}  // namespace prt
}  // namespace gloam
