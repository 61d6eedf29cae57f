// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Textures and materials of sixteen places at once (material_lanes_simd.cpp).
#pragma once

#include "reference/path_lanes.h"
#include "reference/texture_reader.h"

namespace gloam::reference {

/// TextureReader::at of texture coordinates, without alpha.
void readTexture(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v, LaneVectors& color);
/// Sends for what that will read of those lanes.
void sendForTexture(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v,
                    std::uint32_t mask);

/// What a surface is made of, lane by lane: factors of one material times what its maps and vertex colours say.
struct MaterialLanes {
  LaneVectors color, metallic_roughness;  ///< maps alone; of the latter y is roughness, z metallic
  glm::vec3 base_color{1.0f};
  float metallic = 1.0f, roughness = 1.0f, specular = 1.0f;
};
/// brdf::makeLobes in the lanes of `mask`.
void setLobes(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material);

struct TangentLanes {
  LaneVectors texel;  ///< of the normal map
  LaneVectors tangent;
  LaneFloats handedness;
  float scale = 1.0f;
};
/// trace::mappedNormal in the lanes of `mask`, in the frame of the side on which the mesh's normals are: turned round as a
/// whole where the other side is seen.
void tiltNormals(PathLanes& lanes, std::uint32_t mask, const CornerLanes& corners, const TangentLanes& map);

}  // namespace gloam::reference
