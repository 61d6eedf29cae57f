// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tessellation of a scene whose vertices are too sparse for the shadows on it (Sloan, Kautz, Snyder 2002, section 5; PRT-3): the
// shadowed transfer is measured along few directions, where it bends triangles are split, until it does not.
#include <fmt/format.h>
#include <gloam/bake.h>

#include <algorithm>

#include "scene/threads.h"
#include "techniques/prt/prt_tessellate_error.h"
#include "techniques/prt/prt_tessellate_split.h"

namespace gloam {
namespace {

using namespace prt;

/// Shares of the scene's diagonal: how far apart large triangles are measured, and below which nothing is split. Where light
/// and shadow meet at an edge no triangle is small enough.
constexpr float kSpacing = 1.0f / 64.0f, kFinest = 1.0f / 1024.0f;
constexpr int kMostPasses = 64;

void check(const TessellateOptions& options) {
  if (!(options.error >= 0.005f && options.error <= 1.0f))
    throw Error("tessellate", fmt::format("error is {}; expected 0.005 to 1", options.error));
  if (options.order < 3 || options.order > 6)
    throw Error("tessellate", fmt::format("order is {}; expected 3 to 6", options.order));
  if (options.directions != 0 && (options.directions < 256 || options.directions > 65536))
    throw Error("tessellate",
                fmt::format("directions is {}; expected 256 to 65536, or 0", options.directions));
  if (options.max_vertices > 100000000)
    throw Error("tessellate",
                fmt::format("max_vertices is {}; expected up to 100000000", options.max_vertices));
}

/// Errors of triangles that stayed whole go on; parts are to be measured.
void handOn(const std::vector<std::vector<std::uint32_t>>& parents, std::vector<std::vector<float>>& errors) {
  for (std::size_t i = 0; i < parents.size(); ++i) {
    std::vector<float> next(parents[i].size());
    for (std::size_t t = 0; t < next.size(); ++t) {
      const std::uint32_t parent = parents[i][t];
      const bool part =
          (t > 0 && parents[i][t - 1] == parent) || (t + 1 < next.size() && parents[i][t + 1] == parent);
      next[t] = part ? TessellationError::kUnknown : errors[i][parent];
    }
    errors[i] = std::move(next);
  }
}

float greatest(const std::vector<std::vector<float>>& errors) {
  float most = 0.0f;
  for (const std::vector<float>& of_mesh : errors) {
    for (const float error : of_mesh) most = std::max(most, error);
  }
  return most;
}

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
    std::vector<std::vector<float>> errors(posed_.instances.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const Instance& instance = posed_.instances[i];
      if (!instance.deformed())
        errors[i].assign(scene_.meshes[std::size_t(instance.mesh)].triangleCount(),
                         TessellationError::kUnknown);
    }
    for (report.passes = 0; report.passes <= kMostPasses; ++report.passes) {
      measure.measure(scene_, posed_, progress, errors);
      if (report.passes == 0) report.error_before = double(greatest(errors));
      std::vector<TriangleRef> chosen = choose(errors, report);
      progress.report(1.0 - 1.0 / double(report.passes + 2),
                      fmt::format("splitting triangles: {} vertices", mesh_.vertexCount()));
      if (chosen.empty() || mesh_.full() || report.passes == kMostPasses) break;
      const std::size_t before = mesh_.triangleCount();
      handOn(mesh_.split(chosen, options_.max_vertices), errors);
      if (mesh_.triangleCount() == before) break;
      posed_ = pose(scene_, options_.time_s);
    }
    report.vertices_after = mesh_.vertexCount();
    report.triangles_after = mesh_.triangleCount();
    report.error_after = double(greatest(errors));
  }

  Scene take() { return std::move(scene_); }

 private:
  /// Triangles to be split, the worst first.
  std::vector<TriangleRef> choose(const std::vector<std::vector<float>>& errors,
                                  TessellateReport& report) const {
    std::vector<TriangleRef> chosen;
    report.above = report.at_finest = 0;
    for (std::uint32_t i = 0; i < errors.size(); ++i) {
      for (std::uint32_t t = 0; t < errors[i].size(); ++t) {
        if (!(errors[i][t] > options_.error)) continue;
        ++report.above;
        if (mesh_.longestEdge({i, t}) > kFinest * diagonal_) {
          chosen.push_back({i, t});
        } else {
          ++report.at_finest;
        }
      }
    }
    std::ranges::stable_sort(chosen, std::greater(),
                             [&](const TriangleRef& r) { return errors[r.instance][r.triangle]; });
    return chosen;
  }

  Scene scene_;
  const TessellateOptions& options_;
  PosedScene posed_;
  SplitMesh mesh_;
  float diagonal_ = 0.0f;
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
