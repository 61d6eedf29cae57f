// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tessellation of a scene whose vertices are too sparse for the shadows on it (Sloan, Kautz, Snyder 2002, section 5; PRT-3): the
// shadowed transfer is measured along few directions, where it bends triangles are split, until it does not.
#include <fmt/format.h>
#include <gloam/bake.h>

#include <algorithm>
#include <cmath>

#include "scene/threads.h"
#include "techniques/prt/prt_tessellate_cut.h"
#include "techniques/prt/prt_tessellate_error.h"
#include "techniques/prt/prt_tessellate_split.h"

namespace gloam {
namespace {

using namespace prt;

/// Shares of the scene's diagonal: how far apart large triangles are measured, and below which nothing is split. Where light
/// and shadow meet at an edge no triangle is small enough.
constexpr float kSpacing = 1.0f / 64.0f, kFinest = 1.0f / 1024.0f;
/// The same where splitting has not lowered the error: across an edge of light the parts err as the whole does, and vertices only
/// narrow the band that errs. Given up after so many generations, two of which halve a triangle's edges.
constexpr float kFinestAtEdges = 1.0f / 256.0f, kLittleFall = 0.8f;
constexpr int kFruitless = 4;
constexpr int kMostPasses = 64;
/// Of the area that is still above the bound: less is not worth a pass. Splitting one splits its neighbours, so that a few triangles of the
/// finest kind run along an edge for dozens of passes.
constexpr double kLeastArea = 1e-2;
/// Of an edge, one after the other; and the pass after which none is cut: a triangle as large as the scene is below kSpacing then.
constexpr int kMostCuts = 4, kLastCut = 12;

void check(const TessellateOptions& options) {
  if (!(options.error >= 0.005f && options.error <= 1.0f))
    throw Error("tessellate", fmt::format("error is {}; expected 0.005 to 1", options.error));
  if (options.order < 3 || options.order > 6)
    throw Error("tessellate", fmt::format("order is {}; expected 3 to 6", options.order));
  if (options.directions != 0 && (options.directions < 256 || options.directions > 65536))
    throw Error("tessellate",
                fmt::format("directions is {}; expected 256 to 65536, or 0", options.directions));
  if (options.max_rays < 1000000)
    throw Error("tessellate", fmt::format("max_rays is {}; expected 1000000 or more", options.max_rays));
  if (options.max_vertices > 100000000)
    throw Error("tessellate",
                fmt::format("max_vertices is {}; expected up to 100000000", options.max_vertices));
}

/// What a triangle's ancestors have come to.
struct Lineage {
  float error = 0.0f;          ///< of the triangle that it is a part of
  std::uint8_t fruitless = 0;  ///< generations in which splitting lowered it little
};

/// Errors of triangles that stayed whole go on; parts are to be measured.
void handOn(const std::vector<std::vector<std::uint32_t>>& parents, std::vector<std::vector<float>>& errors,
            std::vector<std::vector<Lineage>>& lineages) {
  for (std::size_t i = 0; i < parents.size(); ++i) {
    std::vector<float> next(parents[i].size());
    std::vector<Lineage> lines(next.size());
    for (std::size_t t = 0; t < next.size(); ++t) {
      const std::uint32_t parent = parents[i][t];
      const bool part =
          (t > 0 && parents[i][t - 1] == parent) || (t + 1 < next.size() && parents[i][t + 1] == parent);
      next[t] = part ? TessellationError::kUnknown : errors[i][parent];
      lines[t] = lineages[i][parent];
      if (part && errors[i][parent] != TessellationError::kUnknown) lines[t].error = errors[i][parent];
    }
    errors[i] = std::move(next);
    lineages[i] = std::move(lines);
  }
}

/// Over all triangles: the greatest error, and what it is by area.
struct Summary {
  double greatest = 0.0, mean = 0.0, above_area = 0.0;
};

class Tessellation {
 public:
  Tessellation(Scene scene, const TessellateOptions& options)
      : scene_(std::move(scene)),
        options_(options),
        posed_(pose(scene_, options.time_s)),
        mesh_(scene_, posed_) {
    diagonal_ = glm::distance(posed_.bounds_min, posed_.bounds_max);
  }

  void run(const Progress& progress, TessellateReport& report) {
    const TessellationError measure(options_, kSpacing * diagonal_);
    report.vertices_before = mesh_.vertexCount();
    report.triangles_before = mesh_.triangleCount();
    if (report.triangles_before == 0)
      throw Error(scene_.name.empty() ? "tessellate" : scene_.name,
                  "the scene has no rigid triangles to split");
    begin();
    const Scene whole = scene_;  // of the same shape, however it is split
    const PosedScene posed = pose(whole, options_.time_s);
    const trace::Tracer tracer(whole, posed, {.reproducible = true, .rigid_only = true}, {});
    const SplitMesh::Crossing crossing = crossingsWith(tracer, whole, posed);
    cut(crossing);
    posed_ = pose(scene_, options_.time_s);
    for (report.passes = 0; report.passes <= kMostPasses; ++report.passes) {
      measureParts(measure, progress, report);
      if (report.passes == 0) {
        const Summary before = summary();
        report.error_before = before.greatest;
        report.mean_error_before = before.mean;
      }
      const std::vector<TriangleRef> chosen = choose(report);
      if (chosen.empty() || mesh_.full() || report.out_of_rays || report.passes == kMostPasses) break;
      const std::size_t before = mesh_.triangleCount();
      handOn(mesh_.split(chosen, options_.max_vertices), errors_, lineages_);
      if (mesh_.triangleCount() == before) break;
      if (report.passes < kLastCut) cut(crossing);
      posed_ = pose(scene_, options_.time_s);
    }
    report.vertices_after = mesh_.vertexCount();
    report.triangles_after = mesh_.triangleCount();
    const Summary after = summary();
    report.error_after = after.greatest;
    report.mean_error_after = after.mean;
    report.above_area = after.above_area;
  }

  Scene take() { return std::move(scene_); }

 private:
  void begin() {
    errors_.resize(posed_.instances.size());
    lineages_.resize(errors_.size());
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      const Instance& instance = posed_.instances[i];
      if (instance.deformed()) continue;
      const std::size_t triangles = scene_.meshes[std::size_t(instance.mesh)].triangleCount();
      errors_[i].assign(triangles, TessellationError::kUnknown);
      lineages_[i].resize(triangles);
    }
  }

  /// Edges that enter other bodies, at their surface, once they are short; not the shortest.
  void cut(const SplitMesh::Crossing& crossing) {
    for (int k = 0; k < kMostCuts; ++k) {
      const std::size_t before = mesh_.triangleCount();
      handOn(mesh_.cut(crossing, {double(kFinestAtEdges * diagonal_), double(kSpacing * diagonal_)},
                       options_.max_vertices),
             errors_, lineages_);
      if (mesh_.triangleCount() == before) break;
    }
  }

  void measureParts(const TessellationError& measure, const Progress& progress, TessellateReport& report) {
    const auto fraction = [&](int passes) { return 1.0f - 1.0f / float(passes + 1); };
    const std::vector<std::vector<float>> before = errors_;
    const std::size_t left = options_.max_rays - std::min(options_.max_rays, report.rays);
    report.rays += measure.measure(scene_, posed_, progress,
                                   {fraction(report.passes), fraction(report.passes + 1)}, left, errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      for (std::size_t t = 0; t < errors_[i].size(); ++t) {
        if (errors_[i][t] == TessellationError::kUnknown) report.out_of_rays = true;
        if (before[i][t] != TessellationError::kUnknown) continue;
        Lineage& line = lineages_[i][t];
        const bool fruitless = report.passes > 0 && errors_[i][t] > kLittleFall * line.error;
        line.fruitless = fruitless ? std::uint8_t(std::min(255, line.fruitless + 1)) : std::uint8_t(0);
      }
    }
  }

  Summary summary() const {
    Summary result;
    double area = 0.0, squares = 0.0, above = 0.0;
    for (std::uint32_t i = 0; i < errors_.size(); ++i) {
      for (std::uint32_t t = 0; t < errors_[i].size(); ++t) {
        const double of_triangle = mesh_.area({i, t}), error = std::max(0.0, double(errors_[i][t]));
        area += of_triangle;
        squares += of_triangle * error * error;
        if (error > double(options_.error)) above += of_triangle;
        result.greatest = std::max(result.greatest, error);
      }
    }
    if (area <= 0.0) return result;
    result.mean = std::sqrt(squares / area);
    result.above_area = above / area;
    return result;
  }

  bool isWorthSplitting(const TriangleRef& triangle) const {
    const bool fruitless = lineages_[triangle.instance][triangle.triangle].fruitless >= kFruitless;
    return mesh_.longestEdge(triangle) > (fruitless ? kFinestAtEdges : kFinest) * diagonal_;
  }

  /// Triangles to be split, the worst first.
  std::vector<TriangleRef> choose(TessellateReport& report) const {
    std::vector<TriangleRef> chosen;
    double area = 0.0, area_chosen = 0.0;
    report.above = report.at_finest = 0;
    for (std::uint32_t i = 0; i < errors_.size(); ++i) {
      for (std::uint32_t t = 0; t < errors_[i].size(); ++t) {
        if (!(errors_[i][t] > options_.error)) continue;
        ++report.above;
        const double own = mesh_.area({i, t});
        area += own;
        if (isWorthSplitting({i, t})) {
          chosen.push_back({i, t});
          area_chosen += own;
        } else {
          ++report.at_finest;
        }
      }
    }
    if (report.passes > 0 && area_chosen < kLeastArea * area) {
      report.at_finest = report.above;
      return {};
    }
    std::ranges::stable_sort(chosen, std::greater(),
                             [&](const TriangleRef& r) { return errors_[r.instance][r.triangle]; });
    return chosen;
  }

  Scene scene_;
  const TessellateOptions& options_;
  PosedScene posed_;
  SplitMesh mesh_;
  float diagonal_ = 0.0f;
  std::vector<std::vector<float>> errors_;      // [instance][triangle]
  std::vector<std::vector<Lineage>> lineages_;  // the same
};

}  // namespace

Scene tessellateForTransfer(const Scene& scene, const TessellateOptions& options, const Progress& progress,
                            TessellateReport* report) {
  check(options);
  TessellateReport local;
  TessellateReport& done = report ? *report : local;
  done = {};
  Tessellation work(makeInstancesUnique(scene), options);
  withThreads(options.threads, [&] { work.run(progress, done); });
  return work.take();
}

}  // namespace gloam
