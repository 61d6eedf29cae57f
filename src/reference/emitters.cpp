// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/emitters.h"

#include <cmath>

#include "math/sampling.h"
#include "trace/surface.h"

namespace gloam::reference {
namespace {

constexpr std::uint32_t kTexturePoints = 64;
// Of the brightest a texture can be: what the points of a triangle missed must not be left out altogether.
constexpr float kLeastTexture = 0.02f;

float sizeOf(const glm::vec3& radiance) {
  return (radiance.r + radiance.g + radiance.b) * (1.0f / 3.0f);
}

float meanEmission(const Scene& scene, const Mesh& mesh, int triangle) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  if (!material.emission_map) return sizeOf(material.emission);
  float sum = 0.0f;
  for (std::uint32_t i = 0; i < kTexturePoints; ++i) {
    const glm::vec3 b = sampling::uniformTriangle(sampling::r2(i));
    sum += sizeOf(trace::emission(scene, mesh, {triangle, b.y, b.z}));
  }
  return std::max(sum / float(kTexturePoints), kLeastTexture * sizeOf(material.emission));
}

}  // namespace

void Emitters::add(const Scene& scene, const Mesh& mesh, int instance, trace::Tracer::Triangles triangles,
                   std::vector<float>& power) {
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const glm::uvec3& v = triangles.vertices[t];
    Triangle& triangle = triangles_.emplace_back();
    triangle.instance = instance;
    triangle.triangle = int(t);
    triangle.corner = triangles.positions[v.x];
    triangle.edge_u = triangles.positions[v.y] - triangle.corner;
    triangle.edge_v = triangles.positions[v.z] - triangle.corner;
    triangle.ray_offset =
        trace::surfaceOffset(triangle.corner, triangles.positions[v.y], triangles.positions[v.z]);
    const glm::vec3 cross = glm::cross(triangle.edge_u, triangle.edge_v);
    const float length = glm::length(cross);
    const bool has_area = length > 0.0f && std::isfinite(length);
    if (has_area) triangle.normal = cross / length;
    power.push_back(has_area ? 0.5f * length * meanEmission(scene, mesh, int(t)) : 0.0f);
    area_pdf_.push_back(has_area ? 2.0f / length : 0.0f);
  }
}

Emitters::Emitters(const Scene& scene, const PosedScene& posed, const Surfaces& surfaces,
                   const trace::Tracer& tracer)
    : surfaces_(&surfaces), first_(posed.instances.size(), kNotHere) {
  std::vector<float> power;
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const auto triangles = tracer.triangles(int(i));
    if (!surfaces.emits(int(i)) || !triangles.vertices) continue;
    first_[i] = triangles_.size();
    add(scene, scene.meshes[std::size_t(posed.instances[i].mesh)], int(i), triangles, power);
  }
  choice_ = Distribution(power);
  for (std::size_t i = 0; i < area_pdf_.size(); ++i)
    area_pdf_[i] = choice_.empty() ? 0.0f : area_pdf_[i] * choice_.probability(std::uint32_t(i));
}

Emitters::Sample Emitters::sample(std::uint32_t number, const glm::vec2& u) const {
  const std::uint32_t chosen = choice_.choose(number).index;
  const Triangle& t = triangles_[chosen];
  const glm::vec3 b = sampling::uniformTriangle(u);
  Sample sample{t.corner + b.y * t.edge_u + b.z * t.edge_v, t.normal, t.ray_offset, area_pdf_[chosen]};
  if (!surfaces_->isHole(t.instance, t.triangle, b.y, b.z))
    sample.radiance = surfaces_->emission(t.instance, t.triangle, b.y, b.z);
  return sample;
}

}  // namespace gloam::reference
