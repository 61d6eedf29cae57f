// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Textures and materials of sixteen places at once (material_lanes_simd.cpp).
#pragma once

#include "reference/path_lanes.h"
#include "reference/texture_reader.h"

namespace gloam::reference {

/// One texture a lane.
using TextureLanes = const TextureTable* [kLanes];
/// Where texture coordinates lie in their textures: the four texels around, and how far it is from the first to the others.
struct TexelLanes {
  LaneInts corners[4];  ///< upper left, upper right, lower left, lower right
  LaneFloats across, down;
};
/// In the lanes of `mask`, a bit each, which have a texture.
void findTexels(const TextureLanes& textures, std::uint32_t mask, const LaneFloats& u, const LaneFloats& v,
                TexelLanes& texels);
/// TextureReader::at without alpha; all sRGB or none. White in the other lanes.
void readTexels(const TextureLanes& textures, std::uint32_t mask, const TexelLanes& texels, bool srgb,
                LaneVectors& color);

/// What a material says of all its surface.
struct alignas(32) MaterialFactors {
  glm::vec3 base_color{1.0f};
  float metallic = 1.0f, roughness = 1.0f, specular = 1.0f, normal_scale = 1.0f, unused = 0.0f;
};
/// What surfaces are made of, lane by lane: factors of a material times what its maps and vertex colours say.
struct MaterialLanes {
  LaneVectors color, metallic_roughness;  ///< maps alone; of the latter y is roughness, z metallic
  const MaterialFactors* factors[kLanes];
};
/// brdf::makeLobes in the lanes of `mask`.
void setLobes(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material);

struct TangentLanes {
  LaneVectors texel;                    ///< of the normal map
  const glm::vec4* corners[kLanes][3];  ///< tangents of the triangle's corners
  LaneFloats u, v, side;                ///< place on it; PlaceLanes::side
  const MaterialFactors* factors[kLanes];
};
/// trace::mappedNormal in the lanes of `mask`, in the frame of the side on which the mesh's normals are: turned round as a
/// whole where the other side is seen.
void tiltNormals(PathLanes& lanes, std::uint32_t mask, const TangentLanes& map);

}  // namespace gloam::reference
