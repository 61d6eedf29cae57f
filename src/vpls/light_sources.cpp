// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "vpls/light_sources.h"

#include <numbers>

#include "math/punctual.h"
#include "math/sampling.h"
#include "trace/surface.h"

namespace gloam::vpls {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::uint32_t kTexturePoints = 16;
/// Of the brightest that a texture can be: what the points missed is not left out altogether.
constexpr float kLeastTexture = 0.02f;

float sizeOf(const glm::vec3& v) {
  return (v.r + v.g + v.b) / 3.0f;
}

/// A spot's cone, widened a little where it has no width at all.
float cosOuter(const frame::LightRow& lamp) {
  return std::min(lamp.cos_outer, 0.999999f);
}

}  // namespace

std::vector<float> meanEmission(const Scene& scene, const Mesh& mesh) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  if (material.emission == glm::vec3(0.0f)) return {};
  if (!material.emission_map) return std::vector<float>(mesh.triangleCount(), sizeOf(material.emission));
  std::vector<float> means;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    float sum = 0.0f;
    for (std::uint32_t i = 0; i < kTexturePoints; ++i) {
      const glm::vec3 b = sampling::uniformTriangle(sampling::r2(i));
      sum += sizeOf(trace::emission(scene, mesh, {int(t), b.y, b.z}));
    }
    means.push_back(std::max(sum / float(kTexturePoints), kLeastTexture * sizeOf(material.emission)));
  }
  return means;
}

Emitters::Emitters(const visibility::HostWorld& world) : world_(&world) {
  const Scene& scene = world.scene();
  std::vector<std::vector<float>> means;
  for (const Mesh& mesh : scene.meshes) means.push_back(meanEmission(scene, mesh));
  std::vector<double> weights;
  for (std::size_t i = 0; i < world.posed().instances.size(); ++i) {
    const int mesh = world.posed().instances[i].mesh;
    const auto triangles = world.tracer().triangles(int(i));
    if (means[std::size_t(mesh)].empty() || triangles.vertices == nullptr) continue;
    for (std::size_t t = 0; t < scene.meshes[std::size_t(mesh)].triangleCount(); ++t) {
      const glm::uvec3& v = triangles.vertices[t];
      const glm::vec3 &a = triangles.positions[v.x], &b = triangles.positions[v.y],
                      &c = triangles.positions[v.z];
      const glm::vec3 cross = glm::cross(b - a, c - a);
      const float length = glm::length(cross);
      if (!(length > 0.0f) || !std::isfinite(length)) continue;
      triangles_.push_back({a, b - a, c - a, cross / length, 4.0f * trace::surfaceOffset(a, b, c),
                            0.5f * length, mesh, int(t)});
      weights.push_back(0.5 * double(length) * double(means[std::size_t(mesh)][t]));
    }
  }
  choice_ = Choice(weights);
  power_ = 2.0 * std::numbers::pi * choice_.total();
}

Emitters::Sample Emitters::sample(const glm::vec2& u) const {
  const Choice::Chosen chosen = choice_.choose(u.x);
  if (chosen.probability <= 0.0f) return {};
  const Triangle& t = triangles_[chosen.index];
  const glm::vec3 b = sampling::uniformTriangle({chosen.rest, u.y});
  const Scene& scene = world_->scene();
  const Mesh& mesh = scene.meshes[std::size_t(t.mesh)];
  const trace::SurfacePoint point{t.triangle, b.y, b.z};
  const Material& material = scene.materials[std::size_t(mesh.material)];
  Sample sample{t.corner + b.y * t.edge_u + b.z * t.edge_v, t.normal, t.offset, glm::vec3(0.0f),
                t.area / chosen.probability};
  const bool hole = material.alpha_mask && trace::baseColor(scene, mesh, point).a < material.alpha_cutoff;
  if (!hole) sample.light = sample.area * trace::emission(scene, mesh, point);
  return sample;
}

EntryFaces::EntryFaces(const glm::vec3& low, const glm::vec3& high, const glm::vec3& direction)
    : low_(low), high_(high), direction_(direction) {
  const glm::vec3 side = high - low;
  across_ = glm::abs(direction) * glm::vec3(side.y * side.z, side.z * side.x, side.x * side.y);
  area_ = across_.x + across_.y + across_.z;
}

glm::vec3 EntryFaces::point(const glm::vec2& u) const {
  float at = u.x * area_;
  int axis = 0;
  while (axis < 2 && at >= across_[axis]) at -= across_[axis++];
  const float rest = across_[axis] > 0.0f ? std::min(at / across_[axis], 1.0f) : 0.0f;
  glm::vec3 share;
  share[axis] = direction_[axis] > 0.0f ? 0.0f : 1.0f;
  share[(axis + 1) % 3] = rest;
  share[(axis + 2) % 3] = u.y;
  // A little before the face: a flat scene lies on it.
  return glm::mix(low_, high_, share) - 1e-3f * glm::distance(low_, high_) * direction_;
}

double lampPower(const frame::LightRow& lamp, const glm::vec3& low, const glm::vec3& high) {
  const double size = std::max(0.0, double(sizeOf(lamp.intensity)));
  if (lamp.kind == frame::kLightDirectional)
    return size * double(EntryFaces(low, high, lamp.direction).area());
  if (lamp.kind == frame::kLightPoint) return 4.0 * std::numbers::pi * size;
  const double outer = double(cosOuter(lamp)), inner = std::max(double(lamp.cos_inner), outer);
  return 2.0 * std::numbers::pi * size * ((1.0 - inner) + (inner - outer) / 3.0);
}

LightSources::LightSources(std::vector<frame::LightRow> lamps, const Emitters& emitters,
                           const EnvironmentTable& environment, const glm::vec3& low, const glm::vec3& high,
                           Focus focus)
    : lamps_(std::move(lamps)),
      emitters_(&emitters),
      environment_(&environment),
      low_(low),
      high_(high),
      focus_(std::move(focus)) {
  std::vector<double> powers;
  for (const frame::LightRow& lamp : lamps_) powers.push_back(lampPower(lamp, low, high));
  const glm::vec3 side = high - low;
  const double mean_across =
      0.5 * double(side.x * side.y + side.y * side.z + side.z * side.x);  // Cauchy: a quarter of its surface
  environment_power_ = double(sizeOf(environment.irradiance())) * mean_across;
  powers.push_back(emitters.power());
  powers.push_back(environment_power_);
  choice_ = Choice(powers);
}

Emitted LightSources::fromLamp(const frame::LightRow& lamp, const glm::vec2& direction,
                               const glm::vec2& place) const {
  if (lamp.kind == frame::kLightDirectional) return fromAfar(lamp.direction, lamp.intensity, place);
  Emitted ray;
  ray.origin = lamp.position;
  ray.range = lamp.range;
  if (lamp.kind == frame::kLightPoint) {
    ray.direction = sampling::uniformSphere(direction);
    ray.spread = 4.0f * kPi;
    ray.flux = ray.spread * lamp.intensity;
    return ray;
  }
  const float cos_outer = cosOuter(lamp);
  const glm::vec3 local = sampling::uniformCone(direction, cos_outer);
  ray.direction = sampling::frame(lamp.direction) * local;
  ray.spread = 2.0f * kPi * (1.0f - cos_outer);
  ray.flux = ray.spread * punctual::coneFactor(local.z, lamp.cos_inner, lamp.cos_outer) * lamp.intensity;
  return ray;
}

Emitted LightSources::fromAfar(const glm::vec3& direction, const glm::vec3& irradiance,
                               const glm::vec2& place) const {
  const EntryFaces faces(low_, high_, direction);
  Emitted ray;
  ray.direction = direction;
  ray.area = faces.area();
  const float share = focus_.share(faces.area());
  if (share <= 0.0f) {
    ray.origin = faces.point(place);
  } else {
    const bool focused = place.x < share;
    const glm::vec2 rest(focused ? place.x / share : (place.x - share) / (1.0f - share), place.y);
    ray.origin = focused ? focus_.point(rest, direction) : faces.point(rest);
    if (focused) {  // back to where no scene is
      const float back = glm::distance(ray.origin, 0.5f * (low_ + high_)) + glm::distance(low_, high_);
      ray.origin -= back * direction;
    }
    // Lines beside the box meet nothing, whatever their density.
    const float density = share * focus_.density(ray.origin, direction) + (1.0f - share) / faces.area();
    ray.area = 1.0f / density;
  }
  ray.flux = ray.area * irradiance;
  return ray;
}

Emitted LightSources::emit(const glm::vec2 u[3]) const {
  const Choice::Chosen source = choice_.choose(u[0].x);
  if (source.probability <= 0.0f) return {};
  const glm::vec2 first(source.rest, u[0].y);
  Emitted ray;
  if (source.index < lamps_.size()) {
    ray = fromLamp(lamps_[source.index], first, u[1]);
  } else if (source.index == lamps_.size()) {
    const Emitters::Sample sample = emitters_->sample(first);
    const glm::vec3 normal = u[2].x < 0.5f ? sample.normal : -sample.normal;
    ray.direction = sampling::frame(normal) * sampling::cosineHemisphere(u[1]);
    ray.origin = sample.position + sample.offset * normal;
    ray.area = sample.area;
    ray.spread = kPi;
    ray.flux = 2.0f * kPi * sample.light;
  } else {
    const EnvironmentTable::Sample sample = environment_->sample(first);
    ray = fromAfar(-sample.direction, sample.light, u[1]);
  }
  ray.flux /= source.probability;
  ray.area /= source.probability;
  ray.spread /= source.probability;
  return ray;
}

}  // namespace gloam::vpls
