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
    s.vertices[i] = {s.triangles.positions[i], unitOr(world_from_normal * normals[i], glm::vec3(0.0f)), {}};

  const Material& m = *s.material;
  const Mesh& mesh = *s.mesh;
  const bool colors = mesh.colors.size() == mesh.vertexCount() && !mesh.colors.empty();
  if (colors) s.colors = mesh.colors.data();
  s.uniform = !m.base_color_map && !m.metallic_roughness_map && !colors;
  s.factors = {glm::vec3(m.base_color), m.metallic, m.roughness, m.specular, m.normal_scale};
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
  setMaps(s);
  return s;
}

// What the maps have in common is worked out once for all of them.
void Surfaces::setMaps(Surface& s) {
  const TextureReader* first = nullptr;
  for (const TextureReader* map : {&s.base_color, &s.metallic_roughness, &s.normal}) {
    if (!*map) continue;
    if (!first) first = map;
    s.split_uv = s.split_uv || map->uvs() != first->uvs();
    s.alike = s.alike && map->table().placement == first->table().placement;
  }
  s.alike = s.alike && !s.split_uv;
  if (!first || !first->uvs() || s.split_uv) return;
  for (std::size_t i = 0; i < s.vertices.size(); ++i) s.vertices[i].uv = first->uvs()[i];
}

Surfaces::Surfaces(const Scene& scene, const PosedScene& posed, const trace::Tracer& tracer) : scene_(scene) {
  instances_.resize(posed.instances.size());
  tbb::parallel_for(std::size_t(0), instances_.size(), [&](std::size_t i) {
    instances_[i] = makeSurface(posed.instances[i], tracer.triangles(int(i)));
  });
  for (const Surface& s : instances_) any_emits_ = any_emits_ || (s.emits && s.mesh->triangleCount() > 0);
}

bool Surfaces::arrive(Arrivals& arrivals, int lane, const trace::Hit& hit) const {
  static_assert(offsetof(brdf::Lobes, specular) == 12 && offsetof(brdf::Lobes, exponent) == 24 &&
                offsetof(LobesReady, specular_share) == 28);
  const Surface& s = instances_[std::size_t(hit.instance)];
  const glm::uvec3 corners = s.triangles.vertices[hit.triangle];
  for (int c = 0; c < 3; ++c) arrivals.meetings.corners[lane][c] = &s.vertices[corners[c]];
  arrivals.meetings.lobes[lane] = &s.lobes.lobes.diffuse.x;
  arrivals.meetings.set(lane, hit);
  arrivals.glossy = arrivals.glossy || s.lobes.specular_share > 0.0f || !s.uniform;
  arrivals.varied = (arrivals.varied & ~(1u << lane)) | (s.varied ? 1u << lane : 0u);
  if (s.varied) {
    arrivals.surface[lane] = &s;
    arrivals.corners[lane] = corners;
  }
  return !s.uniform || !s.lobes.black;
}

namespace {

/// The maps of lanes that have some, and what they have in common.
class Maps {
 public:
  Maps(const Surfaces::Arrivals& arrivals, std::uint32_t mask);
  void setMaterial(PathLanes& lanes);
  void setNormals(PathLanes& lanes);

 private:
  struct Map {
    TextureLanes textures;
    std::uint32_t mask = 0;
    void add(int lane, const TextureReader& reader) {
      textures[lane] = &reader.table();
      mask |= std::uint32_t(bool(reader)) << lane;
    }
  };
  void shift(std::uint32_t mask);
  void read(const Map& map, TextureReader Surfaces::Surface::*reader, bool srgb, LaneVectors& color);

  const Surfaces::Arrivals& arrivals_;
  LaneFloats u_, v_;
  Map base_color_, metallic_roughness_, normal_;
  const MaterialFactors* factors_[kLanes];
  std::uint32_t not_uniform_ = 0, colored_ = 0, tilted_ = 0, split_ = 0;
  bool alike_ = true;
  TexelLanes texels_;  // of all maps, where alike
};

Maps::Maps(const Surfaces::Arrivals& arrivals, std::uint32_t mask)
    : arrivals_(arrivals), u_(arrivals.places.u), v_(arrivals.places.v) {
  Map any;
  forLanes(mask, [&](int lane) {
    const Surfaces::Surface& s = *arrivals.surface[lane];
    const std::uint32_t bit = 1u << lane;
    factors_[lane] = &s.factors;
    base_color_.add(lane, s.base_color);
    metallic_roughness_.add(lane, s.metallic_roughness);
    normal_.add(lane, s.normal);
    any.textures[lane] = base_color_.mask & bit           ? base_color_.textures[lane]
                         : metallic_roughness_.mask & bit ? metallic_roughness_.textures[lane]
                                                          : normal_.textures[lane];
    not_uniform_ |= s.uniform ? 0u : bit;
    colored_ |= s.colors ? bit : 0u;
    tilted_ |= s.tangents.empty() ? 0u : bit;
    split_ |= s.split_uv ? bit : 0u;
    alike_ = alike_ && s.alike;
  });
  if (arrivals.shifted) shift(mask & ~split_);
  any.mask = base_color_.mask | metallic_roughness_.mask | normal_.mask;
  if (alike_ && any.mask != 0) findTexels(any.textures, any.mask, u_, v_, texels_);
}

void Maps::shift(std::uint32_t mask) {
  forLanes(mask, [&](int lane) {
    const WorldVertex* const* corners = arrivals_.meetings.corners[lane];
    const glm::vec2 moved = (corners[1]->uv - corners[0]->uv) * arrivals_.shift_u.at[lane] +
                            (corners[2]->uv - corners[0]->uv) * arrivals_.shift_v.at[lane];
    u_.at[lane] += moved.x;
    v_.at[lane] += moved.y;
  });
}

void Maps::read(const Map& map, TextureReader Surfaces::Surface::*reader, bool srgb, LaneVectors& color) {
  if (alike_ || map.mask == 0) return readTexels(map.textures, map.mask, texels_, srgb, color);
  LaneFloats u = u_, v = v_;
  forLanes(map.mask & split_, [&](int lane) {
    const glm::vec2 shift = arrivals_.shifted
                                ? glm::vec2(arrivals_.shift_u.at[lane], arrivals_.shift_v.at[lane])
                                : glm::vec2(0.0f);
    const glm::vec2 uv = (arrivals_.surface[lane]->*reader)
                             .coordinates(arrivals_.corners[lane], arrivals_.meetings.u.at[lane] + shift.x,
                                          arrivals_.meetings.v_and_face[lane][0] + shift.y);
    u.at[lane] = uv.x;
    v.at[lane] = uv.y;
  });
  TexelLanes texels;
  findTexels(map.textures, map.mask, u, v, texels);
  readTexels(map.textures, map.mask, texels, srgb, color);
}

void Maps::setMaterial(PathLanes& lanes) {
  if (not_uniform_ == 0) return;
  MaterialLanes material;
  read(base_color_, &Surfaces::Surface::base_color, true, material.color);
  read(metallic_roughness_, &Surfaces::Surface::metallic_roughness, false, material.metallic_roughness);
  forLanes(colored_, [&](int lane) {
    const glm::uvec3& corners = arrivals_.corners[lane];
    const glm::vec4* colors = arrivals_.surface[lane]->colors;
    const float u = arrivals_.meetings.u.at[lane], v = arrivals_.meetings.v_and_face[lane][0];
    const glm::vec4 color =
        colors[corners.x] * (1.0f - u - v) + colors[corners.y] * u + colors[corners.z] * v;
    material.color.set(lane, material.color.get(lane) * glm::vec3(color));
  });
  std::copy_n(factors_, kLanes, material.factors);
  setLobes(lanes, not_uniform_, material);
}

void Maps::setNormals(PathLanes& lanes) {
  if (tilted_ == 0) return;
  TangentLanes map;
  read(normal_, &Surfaces::Surface::normal, false, map.texel);
  map.u = arrivals_.meetings.u;
  map.side = arrivals_.places.side;
  forLanes(tilted_, [&](int lane) {
    map.v.at[lane] = arrivals_.meetings.v_and_face[lane][0];
    map.factors[lane] = factors_[lane];
    for (int c = 0; c < 3; ++c)
      map.corners[lane][c] = &arrivals_.surface[lane]->tangents[arrivals_.corners[lane][c]];
  });
  tiltNormals(lanes, tilted_, map);
}

}  // namespace

void Surfaces::setVertices(PathLanes& lanes, Arrivals& arrivals, std::uint32_t mask) const {
  reference::setVertices(lanes, arrivals.meetings, mask, arrivals.places);
  if (const std::uint32_t varied = arrivals.varied & mask; varied != 0) {
    Maps maps(arrivals, varied);
    maps.setMaterial(lanes);
    maps.setNormals(lanes);
  }
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
