// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/textures.h"

#include <map>

namespace gloam::frame {

namespace {

// Base colour and emission are stored as sRGB; the others are plain numbers.
constexpr std::array<VkFormat, kTextureSlots> kFormats = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM,
                                                          VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB};

VkSamplerAddressMode addressMode(Wrap wrap) {
  switch (wrap) {
    case Wrap::kClampToEdge:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case Wrap::kMirroredRepeat:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

gpu::Sampler samplerOf(const TextureSlot& slot) {
  gpu::Sampler sampler;
  sampler.filter = slot.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  sampler.wrap_u = addressMode(slot.wrap_u);
  sampler.wrap_v = addressMode(slot.wrap_v);
  return sampler;
}

gpu::Image makeImage(gpu::Device& device, const std::string& name, int width, int height,
                     const std::vector<std::uint8_t>& rgba, VkFormat format) {
  gpu::Image image(device, name, {.format = format, .width = width, .height = height, .mips = gpu::kAllMips});
  image.upload(rgba);
  image.generateMips();
  return image;
}

}  // namespace

std::array<const TextureSlot*, kTextureSlots> textureSlots(const Material& material) {
  return {&material.base_color_map, &material.metallic_roughness_map, &material.normal_map,
          &material.emission_map};
}

Textures::Textures(gpu::Device& device, const Scene& scene) {
  std::map<std::pair<int, VkFormat>, std::size_t> index;
  for (const Material& material : scene.materials) {
    const auto slots = textureSlots(material);
    for (int s = 0; s < kTextureSlots; ++s) {
      if (*slots[std::size_t(s)])
        index.try_emplace({slots[std::size_t(s)]->texture, kFormats[std::size_t(s)]}, 0);
    }
  }
  images_.reserve(index.size() + 1);
  images_.push_back(makeImage(device, "frame.white", 1, 1, {255, 255, 255, 255}, VK_FORMAT_R8G8B8A8_UNORM));
  for (auto& [key, place] : index) {
    const Texture& texture = scene.textures[std::size_t(key.first)];
    place = images_.size();
    const std::string name =
        "texture " + std::to_string(key.first) + (texture.name.empty() ? "" : " " + texture.name);
    images_.push_back(makeImage(device, name, texture.width, texture.height, texture.rgba, key.second));
  }
  for (const Material& material : scene.materials) {
    const auto slots = textureSlots(material);
    auto& bound = bound_.emplace_back();
    for (int s = 0; s < kTextureSlots; ++s) {
      const TextureSlot& slot = *slots[std::size_t(s)];
      const std::size_t place = slot ? index.at({slot.texture, kFormats[std::size_t(s)]}) : 0;
      bound[std::size_t(s)] = {&images_[place], samplerOf(slot)};
    }
  }
}

}  // namespace gloam::frame
