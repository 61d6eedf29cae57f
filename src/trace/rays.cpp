// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/rays.h"

#include <algorithm>

namespace gloam::trace {

RayPacket::RayPacket() {
  setOrigin(glm::vec3(0.0f));
  const auto fill = [](auto* lanes, auto value) { std::fill_n(lanes, kPacketSize, value); };
  fill(t_near, 0.0f);
  fill(direction_x, 0.0f);
  fill(direction_y, 0.0f);
  fill(direction_z, 1.0f);
  fill(time, 0.0f);
  fill(t_far, std::numeric_limits<float>::infinity());
  fill(mask, ~0u);
  fill(id, 0u);
  fill(flags, 0u);
}

void RayPacket::setOrigin(const glm::vec3& origin) {
  for (int i = 0; i < kPacketSize; ++i) {
    origin_x[i] = origin.x;
    origin_y[i] = origin.y;
    origin_z[i] = origin.z;
  }
}

void RayPacket::setRay(int lane, const Ray& ray) {
  origin_x[lane] = ray.origin.x;
  origin_y[lane] = ray.origin.y;
  origin_z[lane] = ray.origin.z;
  direction_x[lane] = ray.direction.x;
  direction_y[lane] = ray.direction.y;
  direction_z[lane] = ray.direction.z;
  t_near[lane] = ray.t_near;
  t_far[lane] = ray.t_far;
}

}  // namespace gloam::trace
