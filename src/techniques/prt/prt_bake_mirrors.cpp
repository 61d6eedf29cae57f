// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Specular reflectors of the object (Sloan, Kautz, Snyder 2002, section 5; PRT-3): a bounce ray that meets one goes on, along
// one direction of the Phong lobe (RF-5) about the mirror direction, until it meets the sky or bounces are used up. Every
// surface on the way also sends what its diffuse part does. So caustics are as sharp as the lobes are, whatever the number
// of bands; the light that makes them is the SH light, as everywhere.
#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_passes.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

// Even over the receiver's directions, which follow a curve over the sphere; turned from point to point and mirror to mirror.
glm::vec2 placeInLobe(std::size_t point, std::uint32_t primary, std::uint32_t mirrors) {
  const glm::uvec4 turn = sampling::pcg4d({std::uint32_t(point), mirrors, 0x6d697272u, 0u});
  return glm::fract(sampling::r2(primary) +
                    glm::vec2(sampling::toUnitFloat(turn.x), sampling::toUnitFloat(turn.y)));
}

}  // namespace

brdf::Lobes BakePasses::lobesAt(const Surface& surface, int triangle, float u, float v) const {
  brdf::Lobes lobes = surface.lobes;
  if (!surface.uniform) {
    const trace::SurfacePoint at{triangle, u, v};
    const trace::MaterialPoint material = trace::materialAt(scene_, *surface.mesh, at, at);
    const float specular = scene_.materials[std::size_t(surface.mesh->material)].specular;
    lobes = brdf::makeLobes(material.base_color, material.metallic, material.roughness, specular);
  }
  if (glossy_ != nullptr && glossy_->exponent > 0.0f) lobes.exponent = glossy_->exponent;
  return lobes;
}

glm::vec3 BakePasses::shadingNormal(const Meeting& at) const {
  const glm::uvec3& corner =
      points_.triangles[points_.first_triangle[std::size_t(at.instance)] + std::size_t(at.triangle)];
  const glm::vec3 sum = (1.0f - at.u - at.v) * points_.normals[corner.x] + at.u * points_.normals[corner.y] +
                        at.v * points_.normals[corner.z];
  const float length = glm::length(sum);
  return length > 1.0e-6f ? sum / length : points_.normals[corner.x];
}

SkyHit BakePasses::skyHit(const MirrorRay& came) {
  return {.direction = came.ray.direction,
          .throughput = came.throughput,
          .primary = came.primary,
          .mirrors = came.mirrors,
          .cosine = came.cosine,
          .solid_angle = 1.0f};
}

// Matrices send on what they can show; behind a mirror everything is followed, since matrices of earlier bounces are gone.
bool BakePasses::isFollowed(const Surface& surface, const brdf::Lobes& lobes, std::uint32_t mirrors) const {
  if (!surface.mirrors) return false;
  if (mirrors > 0 || !surface.glossy) return true;
  return lobes.exponent > shownExponent(glossy_->field_order, lobes.exponent);
}

void BakePasses::reflect(std::size_t point, const MirrorRay& came, const Meeting& at,
                         const brdf::Lobes& lobes, std::vector<MirrorRay>& onward) const {
  if (came.mirrors >= most_mirrors_) return;
  const glm::vec3 throughput = came.throughput * glm::clamp(lobes.specular, 0.0f, 1.0f);
  if (std::max(throughput.r, std::max(throughput.g, throughput.b)) < kLeastThroughput) return;
  const glm::uvec3& corner =
      points_.triangles[points_.first_triangle[std::size_t(at.instance)] + std::size_t(at.triangle)];
  const glm::vec3 place = (1.0f - at.u - at.v) * points_.positions[corner.x] +
                          at.u * points_.positions[corner.y] + at.v * points_.positions[corner.z];
  glm::vec3 geometric = glm::normalize(at.geometric_normal);
  if (glm::dot(geometric, came.ray.direction) > 0.0f) geometric = -geometric;
  const glm::vec3 direction = glm::normalize(
      brdf::samplePhong(lobes.exponent, brdf::mirrorDirection(shadingNormal(at), -came.ray.direction),
                        placeInLobe(point, came.primary, came.mirrors)));
  if (!(glm::dot(direction, geometric) > 0.0f)) return;  // below the surface: lost, as in the reference
  const float offset = trace::surfaceOffset(points_.positions[corner.x], points_.positions[corner.y],
                                            points_.positions[corner.z]);
  onward.push_back({.ray = {.origin = place + offset * geometric, .direction = direction},
                    .throughput = throughput,
                    .cosine = came.cosine,
                    .primary = came.primary,
                    .mirrors = came.mirrors + 1});
}

}  // namespace gloam::prt
