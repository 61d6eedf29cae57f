// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a mesh from a file lacks or has wrong, and how it is mended. All readers end here.
#pragma once

#include <gloam/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace gloam {

/// Rebuilds the vertices: the new vertex i is the old vertex source[i], in every array that the mesh has (also baked
/// transfer). Indices are left to the caller.
void remapVertices(Mesh& mesh, std::span<const std::uint32_t> source);
/// Drops vertices that no triangle uses; the others keep their order.
void removeUnusedVertices(Mesh& mesh);

/// Removes triangles without area; of meshes that morph, only those that name a vertex twice, as the others may open.
/// Returns how many.
std::size_t removeDegenerateTriangles(Mesh& mesh);

/// Computes normals, weighted by angle, and splits vertices where faces meet at more than `crease_rad`; faces are
/// neighbours where their positions coincide, whatever their indices say. A crease of 0 gives flat shading (what glTF asks
/// for where normals are missing), still sharing vertices between coplanar faces. With any other, faces that are folded
/// over onto their neighbours take the normals of these.
void computeNormals(Mesh& mesh, float crease_rad);
inline constexpr float kFlat = 0.0f;
inline constexpr float kSmoothCreaseRad =
    1.0471976f;  ///< 60 degrees: scans come out smooth, boxes keep their edges

/// Unit normals; those that are zero or not finite become the mean of the faces around. Returns how many were bad.
std::size_t repairNormals(Mesh& mesh);

/// Tangents for a normal map, from its texture coordinates: the mean of the triangles' dP/du, made perpendicular to the
/// normal. Vertices between mirrored and plain texture coordinates are split, so that each has one handedness. As
/// MikkTSpace in intent (angle weights, no smoothing over seams), not to the last bit. glTF's sign: w = 1 where the
/// picture is not mirrored.
void computeTangents(Mesh& mesh, const TextureSlot& normal_map);
/// Any tangent frame: where no normal map needs one.
void setAnyTangents(Mesh& mesh);
/// Unit tangents; bad ones are replaced by any perpendicular direction, w becomes 1 or -1. Returns how many were bad.
std::size_t repairTangents(Mesh& mesh);

/// Makes each vertex's weights sum to 1 and points joints without weight to joint 0. A vertex without any weight follows
/// its first joint. Returns how many of those there were.
std::size_t normalizeWeights(Mesh& mesh);

/// Texture slots may ask for coordinates that a mesh lacks: it gets zeros, so that nobody downstream needs to check.
/// Returns true where it was so.
bool fillUvSets(Mesh& mesh, const Material& material);

/// What was mended, counted over all meshes of a file, so that a remark is made once.
class MeshRepairs {
 public:
  enum Kind { kNoArea, kNormals, kTangents, kWeights, kUvSets, kKinds };
  void note(Kind kind, std::size_t count, const std::string& label);
  /// "12 triangles without area are left out (in 3 meshes, first in 'body')"
  Warnings lines() const;

 private:
  struct Tally {
    std::size_t count = 0, meshes = 0;
    std::string first;
  };
  std::array<Tally, kKinds> tallies_;
};

/// All of the above in order, for a mesh whose arrays are filled as far as the file has them: returns false where no
/// triangle is left. `label` names the mesh in remarks; `material` is the mesh's.
bool finishMesh(Mesh& mesh, const Material& material, float crease_rad, const std::string& label,
                MeshRepairs& repairs);

/// Throws Error(place, "label: …") at the first position that is not finite or beyond 1e12. `original` gives a vertex's
/// number in the file; may be empty.
void checkPositions(const Mesh& mesh, std::span<const std::uint32_t> original, const std::string& place,
                    const std::string& label);

}  // namespace gloam
