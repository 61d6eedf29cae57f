// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A material's texture on one mesh, made ready to be read many times: trace::sampleTexture without what does not change.
#pragma once

#include <gloam/scene.h>

namespace gloam::reference {

class TextureReader {
 public:
  /// Reads nothing: white.
  TextureReader() = default;
  /// Keeps references to both.
  TextureReader(const Scene& scene, const TextureSlot& slot, const Mesh& mesh, bool srgb);

  explicit operator bool() const { return texels_ != nullptr; }
  /// Linear, 0 to 1, at (1 - u - v), u, v of a triangle's corners; these may lie beyond the triangle.
  glm::vec4 at(const glm::uvec3& corners, float u, float v) const {
    return texels_ ? read(corners, u, v) : glm::vec4(1.0f);
  }

 private:
  struct Axis {
    Wrap wrap = Wrap::kRepeat;
    int size = 1;
    struct Pair {
      int first, second;
      float rest;  // how far from the first to the second
    };
    Pair at(float coordinate, bool nearest) const;
    int wrapped(int texel) const;
  };
  glm::vec4 read(const glm::uvec3& corners, float u, float v) const;

  const std::uint8_t* texels_ = nullptr;  // rgba
  const glm::vec2* uvs_ = nullptr;        // of the mesh's vertices; null: (0, 0) all over
  const float* linear_ = nullptr;         // of each colour byte
  glm::vec2 column_u_{1.0f, 0.0f}, column_v_{0.0f, 1.0f}, shift_{0.0f};
  Axis across_, down_;
  bool nearest_ = false;
};

}  // namespace gloam::reference
