// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 4.2: surface sample points and albedo of spherical lights (SL-1, SL-2). Differs from the
// paper: albedo is cast by rays, not drawn into cube maps, and where a sphere sees none of its own surface it has the mean of what it
// does see, so that one colour stays one colour; gloss is sent as if it were diffuse; sheets, which have no inside, are met from either side.
#include <fmt/format.h>
#include <gloam/spherical_lights.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "math/sampling.h"
#include "scene/threads.h"
#include "scene/transforms.h"
#include "techniques/spherical_lights/spherical_lights_prepare.h"
#include "trace/surface.h"
#include "trace/tracer.h"

namespace gloam {

namespace spherical_lights {

std::string emissionFingerprint(const SphereSet& set) {
  Fingerprint print;
  addAll(print, set.geometry, set.shape_from_object);
  for (const Sphere& sphere : set.spheres) addAll(print, sphere.center, sphere.radius);
  return print.text();
}

namespace {

constexpr int kMostHits = 256;         // along one ray
constexpr float kSheetVolume = 1e-3f;  // over area^1.5; a ball's is 0.09
constexpr int kFewestWays = kEmissionDirections, kMostWays = 100000;

/// One object in shape space, as rays meet it.
class Segments {
 public:
  Segments(const Scene& scene, const SphereSet& set) : scene_(scene), set_(set) {
    double volume = 0.0, area = 0.0;
    for (const int m : set.meshes) {
      Instance& instance = posed_.instances.emplace_back();
      instance.mesh = m;
      instance.world_from_object = glm::mat4(set.shape_from_object);
      const Mesh& mesh = scene.meshes.at(std::size_t(m));
      for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        glm::dvec3 p[3];
        for (std::size_t c = 0; c < 3; ++c)
          p[c] = glm::dvec3(set.shape_from_object * mesh.positions[mesh.indices[3 * t + c]]);
        volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
        area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
      }
    }
    // trace/ turns the normals of mirrored instances round.
    inward_ = (volume < 0.0) != (glm::determinant(set.shape_from_object) < 0.0f);
    two_sided_ = std::abs(volume) < double(kSheetVolume) * std::pow(area, 1.5);
    tracer_.emplace(scene, posed_, trace::TracerOptions{.reproducible = true, .robust = true});
  }

  /// Of sphere s; empty where it sends nothing that way.
  std::optional<trace::Hit> sampleOf(std::size_t s, const glm::vec3& way) const {
    const Found behind = look(s, way, way, true);
    if (behind.own || behind.any) return behind.own;
    return look(s, -way, way, false).own;
  }
  /// The side of a triangle that is lit, next to its normals.
  bool facesAway(const trace::Hit& hit, const glm::vec3& way) const {
    const Mesh& mesh = meshOf(hit);
    const glm::vec3 normal = normalTransform(set_.shape_from_object) *
                             trace::interpolate(mesh, mesh.normals, {hit.triangle, hit.u, hit.v});
    return glm::dot(normal, glm::dot(hit.geometric_normal, way) < 0.0f ? -hit.geometric_normal
                                                                       : hit.geometric_normal) >= 0.0f;
  }
  const Mesh& meshOf(const trace::Hit& hit) const {
    return scene_.meshes[std::size_t(posed_.instances[std::size_t(hit.instance)].mesh)];
  }

 private:
  struct Found {
    bool any = false;
    std::optional<trace::Hit> own;
  };

  std::size_t nearestSphere(const glm::vec3& point) const {
    std::size_t nearest = 0;
    float least = INFINITY;
    for (std::size_t s = 0; s < set_.spheres.size(); ++s) {
      const float distance = glm::distance(point, set_.spheres[s].center) / set_.spheres[s].radius;
      if (distance < least) least = distance, nearest = s;
    }
    return nearest;
  }

  /// All surface along a ray whose outside lies toward `out`; of the sphere's own the farthest or the nearest.
  Found look(std::size_t s, const glm::vec3& along, const glm::vec3& out, bool farthest) const {
    Found found;
    trace::Ray ray{.origin = set_.spheres[s].center, .direction = along};
    for (int i = 0; i < kMostHits; ++i) {
      const trace::Hit hit = tracer_->closest(ray);
      if (!hit) break;
      const float facing = glm::dot(hit.geometric_normal, out) * (inward_ ? -1.0f : 1.0f);
      if (two_sided_ || facing > 0.0f) {
        found.any = true;
        if (nearestSphere(ray.origin + hit.distance * along) == s && (farthest || !found.own))
          found.own = hit;
      }
      ray.t_near =
          std::max(std::nextafter(hit.distance, INFINITY), hit.distance + 0.5f * tracer_->surfaceOffset(hit));
    }
    return found;
  }

  const Scene& scene_;
  const SphereSet& set_;
  PosedScene posed_;
  bool inward_ = false, two_sided_ = false;
  std::optional<trace::Tracer> tracer_;
};

/// c_S and glow, by directions spread evenly.
void castColours(const Scene& scene, const Segments& segments, std::size_t s, int ways, SphereEmission& out) {
  struct Seen {
    glm::vec3 way, albedo, glow;
  };
  std::vector<Seen> seen;
  glm::vec3 mean(0.0f);
  for (const glm::vec3& way : sampling::fibonacciSphere(ways)) {
    const std::optional<trace::Hit> hit = segments.sampleOf(s, way);
    if (!hit) continue;
    const trace::SurfacePoint point{hit->triangle, hit->u, hit->v};
    const Mesh& mesh = segments.meshOf(*hit);
    seen.push_back({way, trace::reflectance(scene, mesh, point), trace::emission(scene, mesh, point)});
    mean += seen.back().albedo;
  }
  out.albedo = out.glow = sh::ShRgb(kEmissionOrder);
  if (seen.empty()) return;
  mean /= float(seen.size());
  const float each = 4.0f * 3.14159265f / float(ways);
  out.albedo[0] = mean * sh::zonalFactor(0);
  for (const Seen& one : seen) {
    const sh::Sh y = sh::evaluate(kEmissionOrder, one.way);
    for (int i = 0; i < y.size(); ++i) {
      out.albedo[i] += each * y[i] * (one.albedo - mean);
      out.glow[i] += each * y[i] * one.glow;
    }
  }
}

SphereEmission sampleSphere(const Scene& scene, const Segments& segments, std::size_t s, int ways) {
  SphereEmission out;
  for (std::size_t j = 0; j < out.samples.size(); ++j) {
    const glm::vec3& way = emissionDirections()[j];
    const std::optional<trace::Hit> hit = segments.sampleOf(s, way);
    if (!hit) continue;
    out.samples[j] = {hit->instance, std::uint32_t(hit->triangle), hit->u, hit->v,
                      segments.facesAway(*hit, way) ? 1 : -1};
  }
  castColours(scene, segments, s, ways, out);
  return out;
}

}  // namespace
}  // namespace spherical_lights

std::size_t SceneEmission::bytes() const {
  std::size_t spheres = 0;
  for (const SetEmission& set : sets) spheres += set.spheres.size();
  return spheres * (kEmissionDirections * sizeof(EmissionSample) +
                    2 * sh::coefficientCount(kEmissionOrder) * sizeof(glm::vec3));
}

const std::array<glm::vec3, kEmissionDirections>& emissionDirections() {
  static const auto directions = spherical_lights::geodesicDirections();
  return directions;
}

SceneEmission sampleEmission(const Scene& scene, const SceneSpheres& spheres, const EmissionOptions& options,
                             const Progress& progress) {
  using namespace spherical_lights;
  if (options.albedo_directions < kFewestWays || options.albedo_directions > kMostWays)
    throw Error("option 'albedo_directions'",
                fmt::format("{} is not from {} to {}", options.albedo_directions, kFewestWays, kMostWays));
  SceneEmission emission;
  std::size_t done = 0;
  for (const SphereSet& set : spheres.sets) {
    for (const int mesh : set.meshes) {
      if (mesh < 0 || std::size_t(mesh) >= scene.meshes.size())
        throw Error("sphere sets", "belong to another scene");
    }
    SetEmission& out = emission.sets.emplace_back();
    out.fingerprint = emissionFingerprint(set);
    out.spheres.resize(set.spheres.size());
    if (set.spheres.empty()) continue;
    progress.report(double(done) / double(spheres.count()), "emission: samples");
    const Segments segments(scene, set);
    std::atomic<bool> stop = false;
    withThreads(options.threads, [&] {
      tbb::parallel_for(std::size_t(0), set.spheres.size(), [&](std::size_t s) {
        if (stop || progress.stopRequested()) {
          stop = true;
          return;
        }
        out.spheres[s] = sampleSphere(scene, segments, s, options.albedo_directions);
      });
    });
    if (stop) throw Interrupted("emission: interrupted");
    done += set.spheres.size();
    const auto silent = std::ranges::count_if(out.spheres, [](const SphereEmission& sphere) {
      return std::ranges::all_of(sphere.samples, [](const EmissionSample& p) { return p.part == kNone; });
    });
    if (silent > 0)
      emission.warnings.push_back(
          fmt::format("object '{}': {} of {} spheres see no surface of their own and send nothing", set.name,
                      silent, set.spheres.size()));
  }
  return emission;
}

}  // namespace gloam
