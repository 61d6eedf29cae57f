// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rays, packets of rays and what they hit. Plain data; nothing of the tracing library shows here.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace gloam::trace {

inline constexpr int kPacketSize = 16;
inline constexpr int kNoHit = -1;

struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< unit, so that distances are metres
  float t_near = 0.0f;
  float t_far = std::numeric_limits<float>::infinity();
};

/// What a ray meets first. The point is (1 - u - v) p0 + u p1 + v p2 of the triangle's vertices.
struct Hit {
  int instance = kNoHit;  ///< index into PosedScene::instances
  int triangle = kNoHit;  ///< of that instance's mesh
  float distance = std::numeric_limits<float>::infinity();
  float u = 0.0f, v = 0.0f;
  /// Unit, on the side from which the triangle is seen counter-clockwise (mirroring transforms are undone).
  glm::vec3 geometric_normal{0.0f};
  explicit operator bool() const { return instance != kNoHit; }
};

/// A ray that was traced, to be traced again.
struct LoggedRay {
  Ray ray;
  bool occlusion = false;  ///< asked whether it meets anything; else what it meets first
};

/// How far off a triangle a ray has to start so that rounding does not let it meet that triangle again: 32 units in the last
/// place of the largest coordinate of its corners (some micrometres in a room). The origin is moved by this much along the
/// geometric normal, to the side into which the ray leaves. No t_near: in grazing directions it would step over thin gaps.
/// Large triangles elsewhere do not matter: rays are tested relative to their origin.
inline float surfaceOffset(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 largest = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  return std::max(largest.x, std::max(largest.y, largest.z)) * 0x1p-18f;
}

/// Sixteen rays, laid out so that the tracing library takes them as they lie. A lane that was found occluded has
/// t_far = -infinity afterwards; whoever uses the packet again sets t_far again. Nothing else is changed.
struct alignas(64) RayPacket {
  float origin_x[kPacketSize], origin_y[kPacketSize], origin_z[kPacketSize];
  float t_near[kPacketSize];
  float direction_x[kPacketSize], direction_y[kPacketSize], direction_z[kPacketSize];
  float time[kPacketSize];
  float t_far[kPacketSize];
  std::uint32_t mask[kPacketSize], id[kPacketSize], flags[kPacketSize];

  /// All lanes: from the world's origin along +Z to infinity.
  RayPacket();
  void setOrigin(const glm::vec3& origin);
  void setRay(int lane, const Ray& ray);
};

/// The first hits of a packet; instance is kNoHit in lanes that hit nothing or were not traced.
struct alignas(64) HitPacket {
  float normal_x[kPacketSize], normal_y[kPacketSize],
      normal_z[kPacketSize];  ///< as Hit::geometric_normal, not unit
  float u[kPacketSize], v[kPacketSize], distance[kPacketSize];
  std::int32_t instance[kPacketSize], triangle[kPacketSize];
};

/// Which lanes of a packet are traced: all ones or zero, as the tracing library wants them.
struct alignas(64) LaneMask {
  std::int32_t lane[kPacketSize];
  void set(std::uint32_t bits) {
    for (int i = 0; i < kPacketSize; ++i) lane[i] = -static_cast<std::int32_t>((bits >> i) & 1u);
  }
};

}  // namespace gloam::trace
