// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_scene.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <map>

namespace gloam::visibility {

namespace {

/// Takes the buffers that GpuScene binds for shaders.
struct Bound {
  std::map<std::string, gpu::BufferRef, std::less<>> buffers;
  Bound& read(std::string_view name, gpu::BufferRef buffer) {
    buffers[std::string(name)] = buffer;
    return *this;
  }
};

template <class T>
std::vector<T> contents(gpu::BufferRef buffer) {
  std::vector<T> values(buffer.bytes() / sizeof(T));
  if (!values.empty())
    buffer.buffer().downloadBytes(std::as_writable_bytes(std::span(values)), buffer.offset());
  return values;
}

Wrap wrapOf(VkSamplerAddressMode mode) {
  if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE) return Wrap::kClampToEdge;
  if (mode == VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT) return Wrap::kMirroredRepeat;
  return Wrap::kRepeat;
}

/// Textures that were read back, each image once.
class TextureReader {
 public:
  explicit TextureReader(Scene& scene) : scene_(scene) {}
  int of(const gpu::Image& image) {
    const auto [place, is_new] = index_.try_emplace(&image, int(scene_.textures.size()));
    if (is_new) {
      int mip = 0;
      while (mip + 1 < image.desc().mips && std::max(image.width(), image.height()) >> mip > kTextureSide)
        ++mip;
      Texture& texture = scene_.textures.emplace_back();
      texture.name = image.name();
      texture.width = std::max(1, image.width() >> mip);
      texture.height = std::max(1, image.height() >> mip);
      texture.rgba = image.download<std::uint8_t>(mip);
    }
    return place->second;
  }

 private:
  Scene& scene_;
  std::map<const gpu::Image*, int> index_;
};

Material materialOf(const frame::MaterialRow& row) {
  Material material;
  material.base_color = row.base_color;
  material.emission = row.emission;
  material.metallic = row.metallic;
  material.roughness = row.roughness;
  material.specular = row.specular;
  material.alpha_cutoff = row.alpha_cutoff;
  return material;
}

TextureSlot slotOf(const frame::MaterialRow& row, int slot, const frame::Textures::Bound& bound,
                   TextureReader& textures) {
  TextureSlot result;
  result.texture = textures.of(*bound.image);
  result.uv_set = slot;
  result.wrap_u = wrapOf(bound.sampler.wrap_u);
  result.wrap_v = wrapOf(bound.sampler.wrap_v);
  result.nearest = bound.sampler.filter == VK_FILTER_NEAREST;
  const glm::vec4& m = row.texture_from_uv[slot];
  const glm::vec2& o = row.texture_offset[slot];
  result.texture_from_uv = glm::mat3(m.x, m.y, 0.0f, m.z, m.w, 0.0f, o.x, o.y, 1.0f);
  return result;
}

/// Materials of all meshes, with those maps that light depends on: a slot whose picture is the white one has none.
void addMaterials(Scene& host, const frame::GpuScene& scene) {
  std::size_t count = 0;
  for (const frame::GpuMesh& mesh : scene.meshes())
    count = std::max(count, std::size_t(mesh.row.material) + 1);
  if (count == 0) return;
  TextureReader textures(host);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = contents<frame::MaterialRow>(scene.material(std::uint32_t(i))).at(0);
    Material& material = host.materials.emplace_back(materialOf(row));
    const auto slots = frame::textureSlots(material);
    for (const int slot : {0, 1, 3}) {
      const frame::Textures::Bound bound = scene.textures().map(int(i), slot);
      if (bound.image->width() * bound.image->height() == 1 && bound.image->name() == "frame.white") continue;
      *const_cast<TextureSlot*>(slots[std::size_t(slot)]) = slotOf(row, slot, bound, textures);
    }
  }
}

}  // namespace

Scene downloadScene(const frame::GpuScene& scene) {
  Bound bound;
  scene.bindMask(bound);
  const auto positions = contents<glm::vec3>(scene.positions());
  const auto indices = contents<std::uint32_t>(scene.indices());
  const auto uvs = contents<glm::vec2>(scene.uvs());
  const auto colors = contents<glm::uvec2>(bound.buffers.at("colors"));
  Scene host;
  addMaterials(host, scene);
  for (const frame::GpuMesh& part : scene.meshes()) {
    Mesh& mesh = host.meshes.emplace_back();
    const std::size_t count = part.vertex_count;
    mesh.name = part.name;
    mesh.material = int(part.row.material);
    const auto first = positions.begin() + part.row.first_vertex;
    mesh.positions.assign(first, first + std::ptrdiff_t(count));
    const auto first_index = indices.begin() + part.row.first_index;
    mesh.indices.assign(first_index, first_index + std::ptrdiff_t(part.index_count));
    mesh.uv_sets.resize(frame::kTextureSlots);
    for (int slot = 0; slot < frame::kTextureSlots; ++slot) {
      const std::uint32_t uv = part.row.first_uv[slot];
      if (uv != frame::kAbsent && slot != 2)
        mesh.uv_sets[std::size_t(slot)].assign(uvs.begin() + uv, uvs.begin() + uv + std::ptrdiff_t(count));
    }
    if (part.row.first_color != frame::kAbsent) {
      for (std::size_t v = 0; v < count; ++v) {
        const glm::uvec2 packed = colors[part.row.first_color + v];
        mesh.colors.emplace_back(glm::unpackUnorm2x16(packed.x), glm::unpackUnorm2x16(packed.y));
      }
    }
    if (part.alpha_mask) host.materials[part.row.material].alpha_mask = true;
  }
  if (host.materials.empty()) host.materials.emplace_back();
  host.meshes.emplace_back().name = "nothing";
  return host;
}

}  // namespace gloam::visibility
