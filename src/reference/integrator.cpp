// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the camera sees, once a position: the G-buffer's twin. Footprints: the derivative of the point in which a ray meets
// the triangle's plane (Igehy 1999, "Tracing ray differentials", for a flat surface), in the triangle's own coordinates.
#include "reference/integrator.h"

#include <algorithm>
#include <cmath>

#include "reference/paths.h"
#include "scene/camera_rays.h"

namespace gloam::reference {
namespace {

// Texture samples along each side of a footprint for the albedo and normal layers.
constexpr int kFootprintSamples = 4;
// Places along each side of the picture from which is learnt what the camera sees.
constexpr int kLooks = 16;

struct PlaneFrame {
  glm::vec3 edge_u, edge_v, normal;
  float squared;
};

glm::vec2 onTriangle(const PlaneFrame& plane, const glm::vec3& shift) {
  return {glm::dot(glm::cross(shift, plane.edge_v), plane.normal) / plane.squared,
          glm::dot(glm::cross(plane.edge_u, shift), plane.normal) / plane.squared};
}

bool needsPixels(const ReferenceOptions& options) {
  const bool lit = options.light.environment_direct || options.light.environment_indirect;
  return options.background || (lit && options.environment_order == 0);
}

}  // namespace

struct Integrator::Impl {
  std::shared_ptr<const EnvironmentSampler> pixels, light;  // one and the same, unless a projection shines
  CameraRays camera;
  Paths paths;
  bool background;
  std::uint64_t seed;

  Impl(const Scene& scene, const PosedScene& posed, const PosedCamera& given, const Environment& environment,
       const ReferenceOptions& options, const Progress& progress, Sampling how)
      : pixels(needsPixels(options) ? std::make_shared<EnvironmentSampler>(environment, 0)
                                    : std::make_shared<EnvironmentSampler>(Environment{}, 0)),
        light(options.environment_order == 0
                  ? pixels
                  : std::make_shared<EnvironmentSampler>(environment, options.environment_order)),
        camera(
            makeCameraRays(given, options.width * options.supersample, options.height * options.supersample)),
        paths(scene, posed, light, options, how, progress),
        background(options.background && !pixels->black()),
        seed(options.seed) {}

  glm::vec3 unitDirection(float x, float y) const { return glm::normalize(camera.direction(x, y)); }
  void setFootprint(CameraPoint& point, const glm::vec3& direction) const;
  void setMaterial(CameraPoint& point) const;
};

void Integrator::Impl::setFootprint(CameraPoint& point, const glm::vec3& direction) const {
  const trace::Tracer::Triangles triangles = paths.tracer().triangles(point.instance);
  const glm::uvec3& v = triangles.vertices[point.triangle];
  PlaneFrame plane;
  plane.edge_u = triangles.positions[v.y] - triangles.positions[v.x];
  plane.edge_v = triangles.positions[v.z] - triangles.positions[v.x];
  plane.normal = glm::cross(plane.edge_u, plane.edge_v);
  plane.squared = glm::dot(plane.normal, plane.normal);
  const float toward = glm::dot(plane.normal, direction);
  if (toward == 0.0f || !(plane.squared > 0.0f)) return;
  const float reach = camera.perspective ? point.eye_depth : 1.0f;
  const auto footprint = [&](const glm::vec3& step) {
    const glm::vec2 uv =
        onTriangle(plane, reach * (step - direction * (glm::dot(plane.normal, step) / toward)));
    return std::isfinite(uv.x + uv.y) ? uv : glm::vec2(0.0f);
  };
  point.uv_per_x = footprint(camera.step_x);
  point.uv_per_y = footprint(camera.step_y);
}

void Integrator::Impl::setMaterial(CameraPoint& point) const {
  static_assert(kFootprintSamples * kFootprintSamples <= kLanes);
  const Surfaces& surfaces = paths.surfaces();
  const int side = surfaces.textured(point.instance) ? kFootprintSamples : 1;
  const trace::Hit hit{point.instance, point.triangle, 0.0f, point.u, point.v, point.geometric_normal};
  PathLanes lanes{};
  Surfaces::Arrivals arrivals{};
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 place = (glm::vec2(float(i % side), float(i / side)) + 0.5f) / float(side) - 0.5f;
    const glm::vec2 shift = point.uv_per_x * place.x + point.uv_per_y * place.y;
    lanes.to_view.set(i, point.to_eye);
    surfaces.arrive(arrivals, i, hit);
    arrivals.shift_u.at[i] = shift.x;
    arrivals.shift_v.at[i] = shift.y;
  }
  arrivals.shifted = side > 1;
  surfaces.setVertices(lanes, arrivals, (1u << (side * side)) - 1u);
  glm::vec3 albedo(0.0f), normal(0.0f);
  for (int i = 0; i < side * side; ++i) {
    albedo += lanes.diffuse.get(i);
    normal += lanes.normal.get(i);
  }
  point.position = lanes.position.get(0);
  point.albedo = albedo / float(side * side);
  const float length = glm::length(normal);
  point.normal = side > 1 && length > 0.0f ? normal / length : lanes.normal.get(0);
}

Integrator::Integrator(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                       const Environment& environment, const ReferenceOptions& options,
                       const Progress& progress, Sampling sampling)
    : impl_(std::make_unique<Impl>(scene, posed, camera, environment, options, progress, sampling)) {
  const glm::ivec2 size = glm::ivec2(options.width, options.height) * options.supersample;
  std::vector<glm::vec3> seen;
  for (int i = 0; i < kLooks * kLooks; ++i) {
    const glm::ivec2 cell(i % kLooks, i / kLooks);
    const glm::ivec2 place = (2 * cell + 1) * size / (2 * kLooks);
    const CameraPoint point = look(place.x, place.y);
    if (point.instance != kNone) seen.push_back(point.position);
  }
  impl_->paths.shootNear(seen);
}

Integrator::~Integrator() = default;

CameraPoint Integrator::look(int x, int y) const {
  const CameraRays& camera = impl_->camera;
  const float px = float(x) + 0.5f, py = float(y) + 0.5f;
  const glm::vec3 along = camera.direction(px, py);
  const float length = glm::length(along);
  CameraPoint point;
  point.to_eye = -along / length;
  const trace::Ray ray{camera.origin(px, py), along / length, camera.z_near * length};
  const trace::Hit hit = impl_->paths.tracer().closest(ray);
  if (!hit) return point;
  point.instance = hit.instance;
  point.triangle = hit.triangle;
  point.u = hit.u;
  point.v = hit.v;
  point.eye_depth = hit.distance / length;
  point.geometric_normal =
      glm::dot(hit.geometric_normal, ray.direction) > 0.0f ? -hit.geometric_normal : hit.geometric_normal;
  impl_->setFootprint(point, along);
  impl_->setMaterial(point);
  return point;
}

void Integrator::trace(const CameraPoint& point, int x, int y, std::uint32_t pixel, std::uint32_t first,
                       std::span<PathLight> light, std::size_t& rays,
                       std::vector<trace::LoggedRay>* log) const {
  if (point.instance != kNone) return impl_->paths.trace(point, pixel, first, light, rays, log);
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = {};
    if (!impl_->background) continue;
    const glm::vec2 place = Sampler(impl_->seed, pixel, first + std::uint32_t(i)).pair(0);
    light[i][kSeen] =
        impl_->pixels->from(impl_->unitDirection(float(x) + place.x, float(y) + place.y)).radiance;
  }
}

PathLight Integrator::trace(const CameraPoint& point, int x, int y, std::uint32_t pixel, std::uint32_t sample,
                            std::size_t& rays, std::vector<trace::LoggedRay>* log) const {
  PathLight light;
  trace(point, x, y, pixel, sample, {&light, 1}, rays, log);
  return light;
}

bool Integrator::has(LightPath path) const {
  const Sources direct = impl_->paths.direct(), indirect = impl_->paths.indirect();
  if (bouncesOf(path) > impl_->paths.bounces()) return false;
  switch (memberOf(path)) {
    case kEnvironmentDirect:
      return direct.environment;
    case kEnvironmentIndirect:
      return indirect.environment;
    case kLocalDirect:
      return direct.lamps;
    case kLocalIndirect:
      return indirect.lamps;
    case kEmitterDirect:
      return direct.emitters;
    case kEmitterIndirect:
      return indirect.emitters;
    default:
      return impl_->paths.surfaces().anyEmits() || impl_->background;
  }
}

const trace::Tracer& Integrator::tracer() const {
  return impl_->paths.tracer();
}

}  // namespace gloam::reference
