// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A material's texture on one mesh, made ready to be read many times: trace::sampleTexture without what does not change.
#pragma once

#include <gloam/scene.h>

namespace gloam::reference {

struct TextureTable {
  struct Axis {
    Wrap wrap = Wrap::kRepeat;
    int size = 1;
  };
  /// Where texture coordinates lie in the picture, as lanes read it. Textures with the same Placement have texels in the same
  /// places.
  struct Placement {
    float across_from_uv[3] = {1.0f, 0.0f, 0.0f}, width = 1.0f;  ///< KHR_texture_transform: u, v and a shift
    float down_from_uv[3] = {0.0f, 1.0f, 0.0f}, height = 1.0f;
    float wrap_across = 0.0f, wrap_down = 0.0f;  ///< Wrap's numbers
    float nearest = 0.0f, unused = 0.0f;
    bool operator==(const Placement&) const = default;
  };
  const std::uint8_t* texels = nullptr;  ///< rgba
  const float* linear = nullptr;         ///< of each colour byte
  bool srgb = false, nearest = false;
  glm::vec2 from_u{1.0f, 0.0f}, from_v{0.0f, 1.0f}, shift{0.0f};  ///< KHR_texture_transform
  Axis across, down;
  Placement placement;
};

class TextureReader {
 public:
  /// Reads nothing: white.
  TextureReader() = default;
  /// Keeps references to both.
  TextureReader(const Scene& scene, const TextureSlot& slot, const Mesh& mesh, bool srgb);

  explicit operator bool() const { return table_.texels != nullptr; }
  /// Linear, 0 to 1, at (1 - u - v), u, v of a triangle's corners; these may lie beyond the triangle. material_lanes.h has the
  /// same for sixteen.
  glm::vec4 at(const glm::uvec3& corners, float u, float v) const {
    return table_.texels ? read(coordinates(corners, u, v)) : glm::vec4(1.0f);
  }
  /// Of the mesh's vertices; null: (0, 0) all over.
  const glm::vec2* uvs() const { return uvs_; }
  glm::vec2 coordinates(const glm::uvec3& corners, float u, float v) const {
    if (!uvs_) return glm::vec2(0.0f);
    return uvs_[corners.x] * (1.0f - u - v) + uvs_[corners.y] * u + uvs_[corners.z] * v;
  }
  const TextureTable& table() const { return table_; }

 private:
  glm::vec4 read(const glm::vec2& uv) const;

  TextureTable table_;
  const glm::vec2* uvs_ = nullptr;
};

}  // namespace gloam::reference
