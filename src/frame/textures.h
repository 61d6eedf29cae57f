// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>

#include <array>

#include "gpu/image.h"
#include "gpu/sampler.h"

namespace gloam::frame {

/// Slots of a material, in the order of MeshRow::first_uv.
inline constexpr int kTextureSlots = 4;
std::array<const TextureSlot*, kTextureSlots> textureSlots(const Material& material);

/// The scene's textures on the device, each with mips; once as sRGB and once as linear where both are asked
/// for.
class Textures {
 public:
  Textures(gpu::Device& device, const Scene& scene);

  struct Bound {
    const gpu::Image* image;
    gpu::Sampler sampler;
  };
  /// White where the material has no map in that slot.
  Bound map(int material, int slot) const { return bound_[std::size_t(material)][std::size_t(slot)]; }

 private:
  std::vector<gpu::Image> images_;  // filled once: Bound points into it
  std::vector<std::array<Bound, kTextureSlots>> bound_;
};

}  // namespace gloam::frame
