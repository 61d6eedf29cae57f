// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4.2 (PRT-2): matrix x light, convolved and taken at R, against
//   integral of V(s) L(s) lobe(R, s) ds
// by the plainest sum there is, with the lobe in the same bands and with the whole one.
#include "techniques/prt/prt_gloss_bench.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "math/brdf.h"
#include "math/sampling.h"
#include "math/sh_high_order.h"
#include "scene/threads.h"
#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_bake_plan.h"

namespace gloam {
namespace {

using namespace prt;

constexpr std::size_t kBlocks = 24;      // of 16 points
constexpr int kTruthDirections = 50000;  // five times those of a bake, and none of them the same
constexpr std::array<float, 4> kExponents = {3.0f, 10.0f, 30.0f, 100.0f};
constexpr int kMirrors = 8, kLobeSteps = 4096;

/// A lobe over the cosine with its axis, cut to bands or whole.
std::vector<float> lobeTable(int order, float exponent) {
  std::vector<float> table(kLobeSteps + 1);
  const glm::vec3 axis(0.0f, 0.0f, 1.0f);
  const sh::Sh zonal = order > 0 ? sh::rotateZonal(brdf::phongZonal(order, exponent), axis) : sh::Sh(1);
  for (int i = 0; i <= kLobeSteps; ++i) {
    const float z = 2.0f * float(i) / kLobeSteps - 1.0f;
    const glm::vec3 s(std::sqrt(std::max(0.0f, 1.0f - z * z)), 0.0f, z);
    table[std::size_t(i)] =
        order > 0 ? sh::dot(zonal, sh::evaluate(order, s)) : brdf::phongLobe(exponent, axis, s);
  }
  return table;
}
float at(const std::vector<float>& table, float cosine) {
  const float x = std::clamp(0.5f * cosine + 0.5f, 0.0f, 1.0f) * kLobeSteps;
  const auto i = std::min(std::size_t(x), std::size_t(kLobeSteps - 1));
  return glm::mix(table[i], table[i + 1], x - float(i));
}

struct Lobe {
  float exponent, shown;
  std::vector<float> in_bands, whole;
};

struct Sums {
  double matrix = 0.0, cheap = 0.0, unshadowed = 0.0, truth = 0.0, cut = 0.0, whole = 0.0;
};
using SumsOfLobes = std::array<Sums, kExponents.size()>;

class GlossBench {
 public:
  GlossBench(const trace::Tracer& tracer, const BakePoints& points, const BakeState& state,
             const sh::ShRgb& light)
      : tracer_(tracer),
        points_(points),
        state_(state),
        light_(light),
        directions_(sampling::fibonacciSphere(kTruthDirections)),
        tripling_(sh::Tripling::of(light.order, light.order)) {
    for (const float n : kExponents) {
      const float shown = shownExponent(light.order, n);
      lobes_.push_back({n, shown, lobeTable(light.order, shown), lobeTable(0, n)});
    }
    for (const glm::vec3& s : directions_) radiance_.push_back(sh::valueAt(light_, s));
    light_matrix_ = tripling_.lightMatrix({light.c.data(), std::size_t(light.order * light.order)},
                                          int(state.glossy.layout.visibilityCount()));
  }

  void add(std::size_t point, SumsOfLobes& sums) const {
    const glm::vec3 normal = points_.normals[point];
    const std::vector<std::size_t> open = openDirections(point);
    const std::size_t all = state_.glossy.layout.visibilityCount(),
                      few = std::size_t(state_.glossy.layout.fieldCount());
    const float* visibility = &state_.glossy.visibility[state_.glossy.first_row[point] * all];
    std::vector<float> hemisphere(all);
    sh::hemisphereHigh(state_.glossy.layout.visibilityOrder(), normal, hemisphere);
    const sh::ShRgb matrix = field({visibility, all}), cheap = field({visibility, few}),
                    unshadowed = field(hemisphere);
    for (int m = 0; m < kMirrors; ++m) {
      const glm::vec3 mirror = mirrorAbove(normal, point, m);
      for (std::size_t l = 0; l < lobes_.size(); ++l) {
        glm::dvec3 cut(0.0), whole(0.0);
        for (const std::size_t d : open) {
          const float cosine = glm::dot(mirror, directions_[d]);
          cut += glm::dvec3(at(lobes_[l].in_bands, cosine) * radiance_[d]);
          whole += glm::dvec3(at(lobes_[l].whole, cosine) * radiance_[d]);
        }
        const double each = 4.0 * double(sampling::kPi) / kTruthDirections;
        const auto seen = [&](const sh::ShRgb& f) {
          return glm::dvec3(brdf::shadePhong(f, mirror, lobes_[l].shown)) - each * cut;
        };
        Sums& of = sums[l];
        const auto squared = [](const glm::dvec3& v) { return glm::dot(v, v); };
        of.matrix += squared(seen(matrix));
        of.cheap += squared(seen(cheap));
        of.unshadowed += squared(seen(unshadowed));
        of.truth += squared(each * cut);
        of.cut += squared(each * (cut - whole));
        of.whole += squared(each * whole);
      }
    }
  }

 private:
  /// Above the horizon, and nothing in the way.
  std::vector<std::size_t> openDirections(std::size_t point) const {
    std::vector<std::size_t> open;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      if (glm::dot(directions_[d], points_.normals[point]) <= 0.0f) continue;
      if (!tracer_.occluded({.origin = state_.sites[point].origin, .direction = directions_[d]}))
        open.push_back(d);
    }
    return open;
  }

  /// Radiance that arrives: the matrix of that visibility times the light.
  sh::ShRgb field(std::span<const float> visibility) const {
    const std::size_t columns = state_.glossy.layout.visibilityCount();
    sh::ShRgb result(light_.order);
    for (std::size_t i = 0; i < std::size_t(light_.order * light_.order); ++i) {
      for (std::size_t k = 0; k < visibility.size(); ++k)
        result.c[i] += light_matrix_[i * columns + k] * visibility[k];
    }
    return result;
  }

  /// Mirror directions of views up to 75 degrees off the normal, another set at each point.
  static glm::vec3 mirrorAbove(const glm::vec3& normal, std::size_t point, int m) {
    constexpr float kGolden = 2.3999632f;
    const float z = glm::mix(1.0f, std::cos(glm::radians(75.0f)), (float(m) + 0.5f) / kMirrors);
    const float phi = kGolden * float(m + kMirrors * int(point % 1024)), r = std::sqrt(1.0f - z * z);
    const glm::vec3 side = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    return glm::normalize(r * std::cos(phi) * side + r * std::sin(phi) * glm::cross(normal, side) +
                          z * normal);
  }

  const trace::Tracer& tracer_;
  const BakePoints& points_;
  const BakeState& state_;
  const sh::ShRgb& light_;
  std::vector<glm::vec3> directions_, radiance_;
  const sh::Tripling& tripling_;
  std::vector<glm::vec3> light_matrix_;
  std::vector<Lobe> lobes_;
};

PrtGlossRow rowOf(float exponent, int order, const Sums& sums) {
  const auto relative = [](double error, double size) { return size > 0.0 ? std::sqrt(error / size) : 0.0; };
  return {exponent,
          shownExponent(order, exponent),
          relative(sums.matrix, sums.truth),
          relative(sums.cheap, sums.truth),
          relative(sums.unshadowed, sums.truth),
          relative(sums.cut, sums.whole)};
}

}  // namespace

PrtGlossBench benchGloss(const Scene& scene, const sh::ShRgb& light, BakeOptions options) {
  options.kind = TransferKind::kShadowed;
  options.glossy = GlossyMeshes::kAll;
  options.order = options.glossy_order = options.glossy_light_order = light.order;
  const Scene unique = makeInstancesUnique(scene);
  const PosedScene posed = pose(unique, options.time_s);
  const BakePoints points = makeBakePoints(unique, posed);
  if (points.size() == 0) throw Error("bench gloss", "the scene has no rigid triangles to bake");
  const DirectionTables tables = makeDirectionTables(light.order, options.directions, options.directions);
  PrtGlossBench bench{
      .order = light.order, .directions = tables.tiles * kTileSize, .truth_directions = kTruthDirections};
  withThreads(options.threads, [&] {
    const trace::Tracer tracer(unique, posed, {.reproducible = true, .rigid_only = true});
    BakeState state = makeBakeState(points.size(), tables, 0);
    state.glossy = makeGlossyState(unique, posed, points, options);
    GlossyTables glossy(state.glossy.layout, tables);
    glossy.instances = glossyInstances(unique, posed, options.glossy);
    const BakePasses passes(unique, posed, points, tracer, tables, {.turned = true}, &glossy);
    const std::size_t chosen = std::min(state.blocks, kBlocks);
    const auto blockAt = [&](std::size_t i) { return i * state.blocks / chosen; };
    tbb::parallel_for(std::size_t(0), chosen, [&](std::size_t i) { passes.shadowBlock(blockAt(i), state); });
    const GlossBench measure(tracer, points, state, light);
    std::vector<SumsOfLobes> sums(chosen);  // added up in order: the same figures for any number of threads
    std::vector<std::size_t> measured(chosen, 0);
    tbb::parallel_for(std::size_t(0), chosen, [&](std::size_t i) {
      for (std::size_t p = state.blockBegin(blockAt(i)); p < state.blockEnd(blockAt(i)); ++p) {
        if (state.sites[p].place != Place::kOpen || !state.glossy.has(p)) continue;
        measure.add(p, sums[i]);
        ++measured[i];
      }
    });
    for (std::size_t l = 0; l < kExponents.size(); ++l) {
      Sums all;
      for (const SumsOfLobes& of_block : sums) {
        const Sums& s = of_block[l];
        all = {all.matrix + s.matrix, all.cheap + s.cheap, all.unshadowed + s.unshadowed,
               all.truth + s.truth,   all.cut + s.cut,     all.whole + s.whole};
      }
      bench.rows.push_back(rowOf(kExponents[l], light.order, all));
    }
    for (const std::size_t n : measured) bench.points += n;
  });
  return bench;
}

}  // namespace gloam
