// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <volk.h>

namespace gloam::gpu {

/// How a shader filters an image: a plain value. The device makes each distinct sampler once and keeps it.
struct Sampler {
  VkFilter filter = VK_FILTER_LINEAR;
  VkSamplerMipmapMode mip_filter = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  VkSamplerAddressMode wrap_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSamplerAddressMode wrap_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkCompareOp compare = VK_COMPARE_OP_NEVER;  ///< else: a comparison sampler (sampler2DShadow)
  float max_anisotropy = 1.0f;                ///< taken down to 1 where the device has none
  bool operator==(const Sampler&) const = default;
};

inline constexpr Sampler kLinearClamp{};
inline constexpr Sampler kNearestClamp{VK_FILTER_NEAREST, VK_SAMPLER_MIPMAP_MODE_NEAREST};
inline constexpr Sampler kLinearRepeat{VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                       VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT};
/// An equirectangular map: periodic in u, clamped in v.
inline constexpr Sampler kLinearEquirect{VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                         VK_SAMPLER_ADDRESS_MODE_REPEAT};
/// Filtered shadow test: 1 where the reference is less than or equal to the stored depth.
inline constexpr Sampler kShadowLessOrEqual{
    VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_COMPARE_OP_LESS_OR_EQUAL};
/// The same for reversed depth: 1 where the reference is greater than or equal to the stored depth.
inline constexpr Sampler kShadowGreaterOrEqual{
    VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_COMPARE_OP_GREATER_OR_EQUAL};

}  // namespace gloam::gpu
