// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_turn.h"

#include <bit>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <mutex>

#include "math/sampling.h"

namespace gloam::prt {
namespace {

/// Even over all rotations: Shoemake 1992, "Uniform random rotations".
glm::mat3 rotationOf(std::uint32_t number) {
  const glm::uvec4 word = sampling::pcg4d({number, 0x7475726eu, 0u, 0u});
  const float u = sampling::toUnitFloat(word.x), a = 2.0f * sampling::kPi * sampling::toUnitFloat(word.y),
              b = 2.0f * sampling::kPi * sampling::toUnitFloat(word.z);
  const float p = std::sqrt(1.0f - u), q = std::sqrt(u);
  return glm::mat3_cast(
      glm::normalize(glm::quat(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b))));
}

}  // namespace

Turns::Turns(int order) {
  for (std::uint32_t number = 0; number < kCount; ++number) {
    const glm::mat3 matrix = rotationOf(number);
    turns_.push_back({matrix, sh::HighRotation(order, matrix)});
  }
}

const Turns& Turns::of(int order) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<const Turns>> made;
  const std::lock_guard lock(mutex);
  auto& turns = made[order];
  if (!turns) turns.reset(new Turns(order));
  return *turns;
}

const Turn& Turns::at(const glm::vec3& position, const glm::vec3& normal) const {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // one of the two zeros
  const glm::uvec4 of_normal = sampling::pcg4d({bits(normal.x), bits(normal.y), bits(normal.z), 0u});
  const glm::uvec4 word =
      sampling::pcg4d(glm::uvec4(bits(position.x), bits(position.y), bits(position.z), 0u) + of_normal);
  return turns_[word.x % kCount];
}

}  // namespace gloam::prt
