// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The G-buffer's twin (frame/frame_gbuffer.vert.glsl, .frag.glsl): same normals, same materials, same sides.
#include "reference/surfaces.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "scene/transforms.h"

namespace gloam::reference {
namespace {

LobesReady readyLobes(const glm::vec3& base_color, float metallic, float roughness, float specular) {
  return LobesReady(brdf::makeLobes(glm::clamp(base_color, 0.0f, 1.0f), glm::clamp(metallic, 0.0f, 1.0f),
                                    glm::clamp(roughness, 0.0f, 1.0f), specular));
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& fallback) {
  const float squared = glm::dot(v, v);
  return squared > 0.0f && std::isfinite(squared) ? v * (1.0f / std::sqrt(squared)) : fallback;
}

}  // namespace

Surfaces::Surface Surfaces::makeSurface(const Instance& instance, trace::Tracer::Triangles triangles) const {
  Surface s;
  s.mesh = &scene_.meshes[std::size_t(instance.mesh)];
  s.material = &scene_.materials[std::size_t(s.mesh->material)];
  s.triangles = triangles;
  const auto& normals = instance.deformed() ? instance.deformed_normals : s.mesh->normals;
  if (normals.size() != s.mesh->vertexCount())
    throw Error("mesh '" + s.mesh->name + "'",
                fmt::format("{} normals for {} vertices", normals.size(), s.mesh->vertexCount()));
  const glm::mat3 linear = instance.deformed() ? glm::mat3(1.0f) : glm::mat3(instance.world_from_object);
  const glm::mat3 world_from_normal = normalTransform(linear);
  s.own_normals.resize(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i)
    s.own_normals[i] = unitOr(world_from_normal * normals[i], glm::vec3(0.0f));
  s.normals = s.own_normals.data();

  const Material& m = *s.material;
  const bool colors = s.mesh->colors.size() == s.mesh->vertexCount() && !s.mesh->colors.empty();
  s.uniform = !m.base_color_map && !m.metallic_roughness_map && !colors;
  s.lobes = readyLobes(glm::vec3(m.base_color), m.metallic, m.roughness, m.specular);
  const auto& tangents = instance.deformed() ? instance.deformed_tangents : s.mesh->tangents;
  s.normal_mapped = m.normal_map && tangents.size() == s.mesh->vertexCount();
  if (s.normal_mapped) s.tangents = instance.deformed() ? nullptr : tangents.data();
  s.world_from_tangent = linear;
  s.handedness = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  s.emits = m.emission != glm::vec3(0.0f);
  s.holes = m.alpha_mask;
  s.textured = m.base_color_map || m.metallic_roughness_map || s.normal_mapped || (s.emits && m.emission_map);
  return s;
}

Surfaces::Surfaces(const Scene& scene, const PosedScene& posed, const trace::Tracer& tracer) : scene_(scene) {
  instances_.resize(posed.instances.size());
  tbb::parallel_for(std::size_t(0), instances_.size(), [&](std::size_t i) {
    instances_[i] = makeSurface(posed.instances[i], tracer.triangles(int(i)));
  });
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    Surface& s = instances_[i];
    any_emits_ = any_emits_ || (s.emits && s.mesh->triangleCount() > 0);
    if (!s.normal_mapped || s.tangents) continue;
    s.own_tangents = posed.instances[i].deformed_tangents;  // a pose need not outlive its construction
    s.tangents = s.own_tangents.data();
  }
}

void Surfaces::setLobes(Vertex& vertex, int instance, const trace::SurfacePoint& at,
                        const trace::SurfacePoint& texture_at) const {
  const Surface& s = instances_[std::size_t(instance)];
  vertex.lobes = &s.lobes;
  if (s.uniform) return;
  const trace::MaterialPoint point = trace::materialAt(scene_, *s.mesh, at, texture_at);
  vertex.lobes = &vertex.own_lobes.emplace(
      readyLobes(glm::vec3(point.base_color), point.metallic, point.roughness, s.material->specular));
}

glm::vec3 Surfaces::tilted(const Surface& s, const glm::uvec3& corners, const trace::SurfacePoint& at,
                           const trace::SurfacePoint& texture_at, const glm::vec3& normal) const {
  const auto in_world = [&](std::uint32_t vertex) {
    const glm::vec4& t = s.tangents[vertex];
    return glm::vec4(unitOr(s.world_from_tangent * glm::vec3(t), glm::vec3(0.0f)), t.w * s.handedness);
  };
  const glm::vec4 tangent =
      in_world(corners.x) * (1.0f - at.u - at.v) + in_world(corners.y) * at.u + in_world(corners.z) * at.v;
  const glm::vec4 texel = trace::sampleTexture(scene_, s.material->normal_map, *s.mesh, texture_at, false);
  return trace::mappedNormal(normal, tangent, glm::vec3(texel), s.material->normal_scale);
}

void Surfaces::setVertex(Vertex& vertex, const trace::Hit& hit, const glm::vec3& direction,
                         const glm::vec2& texture_shift) const {
  const Surface& s = instances_[std::size_t(hit.instance)];
  const glm::uvec3 corner = s.triangles.vertices[hit.triangle];
  const glm::vec3 &a = s.triangles.positions[corner.x], &b = s.triangles.positions[corner.y],
                  &c = s.triangles.positions[corner.z];
  const float u = hit.u, v = hit.v, w = 1.0f - u - v;
  const glm::vec3 face =
      hit.geometric_normal * -std::copysign(1.0f, glm::dot(direction, hit.geometric_normal));
  const glm::vec3 smooth =
      unitOr(s.normals[corner.x] * w + s.normals[corner.y] * u + s.normals[corner.z] * v, face);
  const float side = glm::dot(smooth, face) < 0.0f ? -1.0f : 1.0f;
  vertex.position = a * w + b * u + c * v;
  vertex.geometric_normal = face;
  vertex.ray_offset = trace::surfaceOffset(a, b, c);
  if (s.uniform && !s.normal_mapped) {
    vertex.normal = smooth * side;
    vertex.lobes = &s.lobes;
    return;
  }
  const trace::SurfacePoint at{hit.triangle, u, v},
      texture_at{hit.triangle, u + texture_shift.x, v + texture_shift.y};
  vertex.normal = side * (s.normal_mapped ? tilted(s, corner, at, texture_at, smooth) : smooth);
  setLobes(vertex, hit.instance, at, texture_at);
}

glm::vec3 Surfaces::emission(int instance, int triangle, float u, float v,
                             const glm::vec2& texture_shift) const {
  const Surface& s = instances_[std::size_t(instance)];
  if (!s.material->emission_map) return s.material->emission;
  return trace::emission(scene_, *s.mesh, {triangle, u + texture_shift.x, v + texture_shift.y});
}

bool Surfaces::isHole(int instance, int triangle, float u, float v) const {
  const Surface& s = instances_[std::size_t(instance)];
  return s.holes && trace::baseColor(scene_, *s.mesh, {triangle, u, v}).a < s.material->alpha_cutoff;
}

}  // namespace gloam::reference
