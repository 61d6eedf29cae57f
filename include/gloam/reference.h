// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Ground truth (REF-1): a path tracer for the same scene, camera, materials and lights as every technique draws, slow and
// plain. docs/accuracy.md says what it includes.
#pragma once

#include <gloam/image.h>
#include <gloam/scene.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace gloam {

/// Raised when the same options give other samples: pictures of another revision, and its checkpoints, are told apart.
inline constexpr int kReferenceRevision = 3;

struct ReferenceOptions {
  int width = 512, height = 512;  ///< 1 to 16384
  int supersample = 1;            ///< 1 to 4, as RenderOptions::supersample: the same points of every pixel
  /// What sends light and by which path. Emission that is seen, and the background, are always there.
  Coverage light = kAllLight;
  int bounces = 1;  ///< surfaces between the first light met and the one that is seen; 0: direct light alone
  int environment_order =
      0;                   ///< 0: the environment's pixels; 1 to 6: its projection to that many bands (SH-2)
  bool background = true;  ///< draw the environment behind the scene (its pixels always); else black, alpha 0
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0: all cores. The picture does not depend on it
};

/// What it took so far, without what a checkpoint brought along.
struct ReferenceReport {
  int samples = 0;       ///< a pixel, those of a checkpoint included
  double noise = 0.0;    ///< PathTracer::noise()
  std::size_t rays = 0;  ///< closest hits and shadow tests
  double seconds = 0.0;  ///< wall clock
  bool resumed = false;
};

/// Paths of one scene at one instant, more and more of them. Unbiased: no clamping, no stopping that depends on values (but
/// for renderReference's `noise`). Sample k of a pixel depends on seed, pixel and k alone, so any number of threads, and any
/// way of splitting the work, makes the same bits. Keeps references to none of the arguments but `scene`.
class PathTracer {
 public:
  /// Throws Error for options out of range, a camera that cannot look and a scene too large for memory; Interrupted.
  PathTracer(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
             const Environment& environment, const ReferenceOptions& options, const Progress& progress = {});
  ~PathTracer();
  PathTracer(PathTracer&&) noexcept;
  PathTracer& operator=(PathTracer&&) noexcept;

  /// Adds that many samples to every pixel. When asked to stop, finishes the tiles in hand (at most some tenths of a second
  /// of work) and throws Interrupted. What is done counts, also where a tile is ahead of others by a few samples; the next
  /// call brings the others up to it first.
  void refine(int samples, const Progress& progress = {});
  int samples() const;      ///< a pixel, so far; the least where a stop has left some pixels behind
  int mostSamples() const;  ///< of the pixels that are ahead then
  /// Root mean square of the pixels' standard errors over the mean of what surfaces reflect (R, G, B together): the relative
  /// RMSE that is to be expected of noise alone. Lamps and sky that are seen themselves would make it look small and do not
  /// count. Infinite below two samples of each position in a pixel, 0 where nothing is reflected.
  double noise() const;
  const ReferenceReport& report() const;

  /// Layers as a render's (docs/images.md: R, G, B, A, direct, indirect, normal, depth, albedo, object), "variance" (R,
  /// G, B: of the mean that a pixel holds) and "seen" (emission and background). Light is stored as floats. Attributes say what is in it (docs/accuracy.md).
  LayeredImage image() const;
  /// The same picture of a part of the light: any subset of ReferenceOptions::light. Its variance is left out.
  LayeredImage image(const Coverage& part) const;
  /// Adds to image() one layer a source and path that has light: "environment_direct", … "emitter_indirect" (of one bounce;
  /// "…_2" and "…_3": of two and three, "…_4": of four and more): what `imageOf` needs.
  LayeredImage imageWithParts() const;

  /// Writes and reads all that refine() has summed up. Reading throws Error where the file is of another scene, camera or
  /// options, or damaged. Written beside and renamed.
  void save(const std::filesystem::path& checkpoint) const;
  void load(const std::filesystem::path& checkpoint);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How far to go: `samples` a pixel, or as many as bring noise() to `noise`, `samples` at most.
struct ReferenceGoal {
  int samples = 64;    ///< 1 to 2^24
  float noise = 0.0f;  ///< 0: no test
  /// Kept every 20 s and when stopped, taken up again by the same call, removed at the end. Empty: none.
  std::filesystem::path checkpoint;
};
/// All of it: traces, keeps the checkpoint, gives imageWithParts() or image(). Throws as PathTracer does.
LayeredImage renderReference(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                             const Environment& environment, const ReferenceOptions& options,
                             const ReferenceGoal& goal, bool parts = false, const Progress& progress = {},
                             ReferenceReport* report = nullptr);

/// What light a reference file holds by its attributes; throws Error(place, …) where it has none.
Coverage coverageOf(const LayeredImage& reference, const std::string& place);
/// That light alone out of a reference file: layers "" (R G B A), "direct", "indirect" and the geometric ones. Throws
/// Error(place, …) that names what is missing: a file without parts can only give all that it holds.
/// `bounces`: of paths with so many at most; below 0: of all. More than three cannot be told apart from all.
LayeredImage imageOf(const LayeredImage& reference, const Coverage& part, const std::string& place,
                     int bounces = -1);
/// What chance leaves in that light: the mean square of its error, R, G, B alike, over all pixels; an upper estimate, as
/// PathTracer::noise() is. Nothing where the file does not tell (a file without parts, of less than all that it holds; or
/// below two samples of each position).
/// Throws Error where what it tells is damaged.
std::optional<double> varianceOf(const LayeredImage& reference, const Coverage& part,
                                 const std::string& place, int bounces = -1);

}  // namespace gloam
