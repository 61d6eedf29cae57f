// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The G-buffer's twin (frame/frame_gbuffer.vert.glsl, .frag.glsl): same normals, same materials, same sides.
#include "reference/surfaces.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <bit>

#include "scene/transforms.h"
#include "trace/surface.h"

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

template <class T>
T between(const std::vector<T>& values, const glm::uvec3& corners, float u, float v) {
  return values[corners.x] * (1.0f - u - v) + values[corners.y] * u + values[corners.z] * v;
}

std::vector<glm::vec4> worldTangents(const std::vector<glm::vec4>& given, const glm::mat3& linear) {
  const float handedness = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  std::vector<glm::vec4> tangents;
  tangents.reserve(given.size());
  for (const glm::vec4& t : given)
    tangents.emplace_back(unitOr(linear * glm::vec3(t), glm::vec3(0.0f)), t.w * handedness);
  return tangents;
}

template <class Visit>
void forLanes(std::uint32_t mask, const Visit& visit) {
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) visit(std::countr_zero(rest));
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
  if (s.triangles.positions) s.vertices.resize(normals.size());
  for (std::size_t i = 0; i < s.vertices.size(); ++i)
    s.vertices[i] = {s.triangles.positions[i], unitOr(world_from_normal * normals[i], glm::vec3(0.0f))};

  const Material& m = *s.material;
  const Mesh& mesh = *s.mesh;
  const bool colors = mesh.colors.size() == mesh.vertexCount() && !mesh.colors.empty();
  if (colors) s.colors = mesh.colors.data();
  s.uniform = !m.base_color_map && !m.metallic_roughness_map && !colors;
  s.lobes = readyLobes(glm::vec3(m.base_color), m.metallic, m.roughness, m.specular);
  s.base_color = TextureReader(scene_, m.base_color_map, mesh, true);
  s.metallic_roughness = TextureReader(scene_, m.metallic_roughness_map, mesh, false);
  s.emission = TextureReader(scene_, m.emission_map, mesh, true);
  const auto& tangents = instance.deformed() ? instance.deformed_tangents : mesh.tangents;
  if (m.normal_map && tangents.size() == mesh.vertexCount() && !tangents.empty()) {
    s.normal = TextureReader(scene_, m.normal_map, mesh, false);
    s.tangents = worldTangents(tangents, linear);
  }
  const bool normal_mapped = !s.tangents.empty();
  s.varied = !s.uniform || normal_mapped;
  s.emits = m.emission != glm::vec3(0.0f);
  s.holes = m.alpha_mask;
  s.textured = m.base_color_map || m.metallic_roughness_map || normal_mapped || (s.emits && m.emission_map);
  return s;
}

Surfaces::Surfaces(const Scene& scene, const PosedScene& posed, const trace::Tracer& tracer) : scene_(scene) {
  instances_.resize(posed.instances.size());
  tbb::parallel_for(std::size_t(0), instances_.size(), [&](std::size_t i) {
    instances_[i] = makeSurface(posed.instances[i], tracer.triangles(int(i)));
  });
  for (const Surface& s : instances_) any_emits_ = any_emits_ || (s.emits && s.mesh->triangleCount() > 0);
}

void Surfaces::setLobes(PathLanes& lanes, int lane, const LobesReady& lobes) {
  lanes.diffuse.set(lane, lobes.lobes.diffuse);
  lanes.specular.set(lane, lobes.lobes.specular);
  lanes.exponent.at[lane] = lobes.lobes.exponent;
  lanes.specular_share.at[lane] = lobes.specular_share;
}

bool Surfaces::arrive(PathLanes& lanes, Arrivals& arrivals, int lane, const trace::Hit& hit,
                      const glm::vec2& texture_shift) const {
  const Surface& s = instances_[std::size_t(hit.instance)];
  const glm::uvec3 corners = s.triangles.vertices[hit.triangle];
  for (int c = 0; c < 3; ++c) {
    const WorldVertex& vertex = s.vertices[corners[c]];
    arrivals.corners.positions[c].set(lane, vertex.position);
    arrivals.corners.normals[c].set(lane, vertex.normal);
  }
  arrivals.corners.u.at[lane] = hit.u;
  arrivals.corners.v.at[lane] = hit.v;
  arrivals.corners.face.set(lane, hit.geometric_normal);
  setLobes(lanes, lane, s.lobes);
  arrivals.glossy = arrivals.glossy || s.lobes.specular_share > 0.0f || !s.uniform;
  arrivals.varied = (arrivals.varied & ~(1u << lane)) | (s.varied ? 1u << lane : 0u);
  if (s.varied) {
    arrivals.instance[lane] = hit.instance;
    arrivals.triangle[lane] = hit.triangle;
    arrivals.texture_u.at[lane] = hit.u + texture_shift.x;
    arrivals.texture_v.at[lane] = hit.v + texture_shift.y;
  }
  return !s.uniform || !s.lobes.black;
}

void Surfaces::spreadFirst(PathLanes& lanes, Arrivals& arrivals) {
  spreadFirstLane(lanes, arrivals.corners);
  arrivals.varied = arrivals.varied & 1u ? 0xffffu : 0u;
  std::fill_n(arrivals.instance + 1, kLanes - 1, arrivals.instance[0]);
  std::fill_n(arrivals.triangle + 1, kLanes - 1, arrivals.triangle[0]);
}

void Surfaces::setMaterial(PathLanes& lanes, const Arrivals& arrivals, std::uint32_t mask,
                           const Surface& s) const {
  const Material& m = *s.material;
  MaterialLanes material;
  material.base_color = glm::vec3(m.base_color);
  material.metallic = m.metallic;
  material.roughness = m.roughness;
  material.specular = m.specular;
  s.read(s.base_color, arrivals, mask, material.color);
  s.read(s.metallic_roughness, arrivals, mask, material.metallic_roughness);
  if (s.colors) {
    forLanes(mask, [&](int lane) {
      const glm::uvec3& corners = s.triangles.vertices[arrivals.triangle[lane]];
      const float u = arrivals.corners.u.at[lane], v = arrivals.corners.v.at[lane];
      material.color.set(lane, material.color.get(lane) * glm::vec3(between(s.mesh->colors, corners, u, v)));
    });
  }
  reference::setLobes(lanes, mask, material);
}

void Surfaces::setNormals(PathLanes& lanes, const Arrivals& arrivals, std::uint32_t mask,
                          const Surface& s) const {
  TangentLanes map;
  map.scale = s.material->normal_scale;
  s.read(s.normal, arrivals, mask, map.texel);
  forLanes(mask, [&](int lane) {
    const glm::uvec3& corners = s.triangles.vertices[arrivals.triangle[lane]];
    const glm::vec4 tangent =
        between(s.tangents, corners, arrivals.corners.u.at[lane], arrivals.corners.v.at[lane]);
    map.tangent.set(lane, glm::vec3(tangent));
    map.handedness.at[lane] = tangent.w;
  });
  tiltNormals(lanes, mask, arrivals.corners, map);
}

void Surfaces::Surface::read(const TextureReader& texture, const Arrivals& arrivals, std::uint32_t mask,
                             LaneVectors& color) const {
  if (!texture) {
    forLanes(mask, [&](int lane) { color.set(lane, glm::vec3(1.0f)); });
    return;
  }
  LaneFloats u, v;
  setCoordinates(texture, arrivals, mask, u, v);
  readTexture(texture.table(), u, v, color);
}

void Surfaces::Surface::setCoordinates(const TextureReader& texture, const Arrivals& arrivals,
                                       std::uint32_t mask, LaneFloats& u, LaneFloats& v) const {
  u = v = {};
  forLanes(mask, [&](int lane) {
    const glm::vec2 uv = texture.coordinates(triangles.vertices[arrivals.triangle[lane]],
                                             arrivals.texture_u.at[lane], arrivals.texture_v.at[lane]);
    u.at[lane] = uv.x;
    v.at[lane] = uv.y;
  });
}

// Lanes of one surface after the other.
template <class Visit>
void Surfaces::forSurfaces(const Arrivals& arrivals, const Visit& visit) const {
  for (std::uint32_t mask = arrivals.varied; mask != 0;) {
    const std::int32_t instance = arrivals.instance[std::countr_zero(mask)];
    std::uint32_t same = 0;
    forLanes(mask, [&](int lane) { same |= std::uint32_t(arrivals.instance[lane] == instance) << lane; });
    visit(instances_[std::size_t(instance)], same);
    mask &= ~same;
  }
}

void Surfaces::setVertices(PathLanes& lanes, const Arrivals& arrivals) const {
  forSurfaces(arrivals, [&](const Surface& s, std::uint32_t mask) {
    for (const TextureReader* texture : {&s.base_color, &s.metallic_roughness, &s.normal}) {
      if (!*texture) continue;
      LaneFloats u, v;
      s.setCoordinates(*texture, arrivals, mask, u, v);
      sendForTexture(texture->table(), u, v, mask);
    }
  });
  reference::setVertices(lanes, arrivals.corners);
  forSurfaces(arrivals, [&](const Surface& s, std::uint32_t mask) {
    if (!s.uniform) setMaterial(lanes, arrivals, mask, s);
    if (!s.tangents.empty()) setNormals(lanes, arrivals, mask, s);
  });
  lanes.glossy = arrivals.glossy;
  if (lanes.glossy) setMirrors(lanes);
}

glm::vec3 Surfaces::emission(int instance, int triangle, float u, float v,
                             const glm::vec2& texture_shift) const {
  const Surface& s = instances_[std::size_t(instance)];
  if (!s.emission) return s.material->emission;
  return s.material->emission *
         glm::vec3(s.emission.at(s.triangles.vertices[triangle], u + texture_shift.x, v + texture_shift.y));
}

bool Surfaces::isHole(int instance, int triangle, float u, float v) const {
  const Surface& s = instances_[std::size_t(instance)];
  return s.holes && trace::baseColor(scene_, *s.mesh, {triangle, u, v}).a < s.material->alpha_cutoff;
}

}  // namespace gloam::reference
