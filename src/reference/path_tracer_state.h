// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a path tracer has gathered so far.
#pragma once

#include <atomic>
#include <functional>

#include "reference/integrator.h"
#include "scene/scene_fingerprint.h"

namespace gloam::reference {

/// Tiles are the unit of work: each has a number of samples of its own, so that work can stop anywhere and go on later.
inline constexpr int kTileSize = 8;
inline constexpr int kMaxSamples = 1 << 24;  ///< a pixel

/// Sums of samples, in double precision, always added in the order of samples: no way of splitting the work shows.
/// Sample k of a pixel starts at position k mod supersample^2, so a round of that many samples holds every position once
/// and its mean is an estimate of the pixel: variance is that of rounds, in which the differences between positions of one
/// pixel (edges, textures) are no noise.
///
/// Samples of a pixel are spread evenly, so their mean is steadier than that of independent ones. By how much is measured:
/// whenever the number of rounds is a power of two, half the difference between the means of the first and the second half
/// is an error of the mean as it happened (a little large: each half is less even than the whole). One such number says
/// little of its pixel, but the ratio of all pixels' squares to what independent samples would have had (`evenness`)
/// says how far to trust the spread of samples.
struct PathSums {
  int width = 0, height = 0;
  int positions = 1;                   ///< supersample^2: samples a round
  std::vector<LightPath> paths;        ///< those that have light, ascending
  std::vector<std::uint32_t> samples;  ///< [tile], of each of its pixels
  std::vector<double> sums;            ///< [pixel][path][rgb]
  std::vector<double> squares;         ///< [pixel][rgb]: of each round's sum of all light
  std::vector<double> round;  ///< [pixel][rgb]: of the round under way; empty where that is one sample
  std::vector<double> half;   ///< [pixel][rgb]: of all light, when rounds were last a power of two
  /// [pixel]: then, the squared error as it happened, and the variance of independent samples; R, G, B together.
  std::vector<double> errors;
  /// [pixel][path][rgb]: sums when rounds were last a power of two, and the errors of their means as they happened then:
  /// what is the noise of any part of the light follows from them. Single precision is enough for errors.
  std::vector<float> part_halves, part_errors;

  int tilesAcross() const { return (width + kTileSize - 1) / kTileSize; }
  std::size_t pixelCount() const { return std::size_t(width) * std::size_t(height); }
  std::size_t tileOf(int x, int y) const {
    return std::size_t(y / kTileSize) * std::size_t(tilesAcross()) + std::size_t(x / kTileSize);
  }
  std::uint32_t least() const;  ///< samples that every pixel has
  std::uint32_t most() const;
  /// Calls visit(data, bytes) for all numbers, in one order.
  template <class Visit>
  void forContents(const Visit& visit) {
    visit(samples.data(), samples.size() * sizeof(samples[0]));
    for (auto* values : {&sums, &squares, &round, &half, &errors}) {
      if (!values->empty()) visit(values->data(), values->size() * sizeof(double));
    }
    for (auto* values : {&part_halves, &part_errors}) {
      if (!values->empty()) visit(values->data(), values->size() * sizeof(float));
    }
  }
};

/// Zeros for a picture of that size. Throws Error where the machine has not so much memory.
PathSums makePathSums(const ReferenceOptions& options, const Integrator& integrator);

/// All light of a pixel, without a round that is not full.
glm::dvec3 lightInRounds(const PathSums& sums, std::size_t pixel);
/// Variance of the mean that a pixel would hold if its samples were independent; infinite below two rounds.
glm::dvec3 independentVariance(const PathSums& sums, std::size_t pixel, std::uint32_t samples);
/// What the true variance is of that, on average over the picture; 1 where that is not known yet.
double evenness(const PathSums& sums);
/// To be called for a pixel with a power of two of full rounds.
void measureError(PathSums& sums, std::size_t pixel, std::uint32_t samples);

/// Variance of the mean that a pixel holds, a value (R, G, B alike), on average over the picture. Infinite below two rounds.
double meanVariance(const PathSums& sums);
/// PathTracer::noise().
double noiseOf(const PathSums& sums);
/// Covariance of the errors of two paths' means, a value of a pixel (R, G, B alike), on average over the picture, for all
/// pairs of PathSums::paths: [row][column]. All of them together are meanVariance().
/// Empty below two rounds.
std::vector<std::vector<double>> partCovariances(const PathSums& sums);

struct TracerState {
  ReferenceOptions options;
  Fingerprint fingerprint;                       ///< of all that samples depend on
  std::string scene, environment_light, camera;  ///< drawnFingerprint() of each, as text
  std::unique_ptr<Integrator> integrator;
  PathSums sums;
  std::vector<CameraPoint> points;  ///< [pixel][position]; empty where that would be too much: found again
  LayeredImage geometry;            ///< normal, depth, albedo, object
  Image alpha;
  ReferenceReport report;
  double rate = 0.0;  ///< samples of a pixel a second, on all threads; 0: not known yet
};

Fingerprint fingerprintOf(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                          const Environment& environment, const ReferenceOptions& options);

/// Finds what every position sees: points (where they are kept), geometry, alpha. Throws Interrupted.
void lookAround(TracerState& state, const Progress& progress);

/// Who follows the work; both may be empty. Asked and told by one thread at a time.
struct Watch {
  std::function<void(double samples)> tell;  ///< samples a pixel, on average
  std::function<bool()> should_stop;
};
/// Brings all tiles to that many samples. False where it was stopped before.
bool advance(TracerState& state, std::uint32_t until, const Watch& watch);

}  // namespace gloam::reference
