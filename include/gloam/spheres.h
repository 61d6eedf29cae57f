// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sphere sets: each object of a scene approximated by a few spheres that together bound its surface (SS-1 to SS-3; Wang et
// al. 2006). Moving things cast soft shadows and colour by them, with nothing else baked.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gloam {

struct Sphere {
  glm::vec3 center{0.0f};
  float radius = 0.0f;
};

/// A vertex that a sphere of a deforming object follows.
struct SphereAnchor {
  int part = 0;              ///< which of the object's meshes
  std::uint32_t vertex = 0;  ///< of that mesh
};

/// How well a set fits, in the unit of its space.
struct SphereFigures {
  double volume = 0.0;         ///< of the object; where it encloses none, of a sheet as thick as was assumed
  double outside_sum = 0.0;    ///< sum over spheres of V(S_i \ O), which the search minimises
  double outside_union = 0.0;  ///< V((S_1 u S_2 u …) \ O), overlaps counted once
  double coverage = 0.0;       ///< share of the surface that lies in at least one sphere
  double relativeSum() const { return volume > 0.0 ? outside_sum / volume : 0.0; }
  double relativeUnion() const { return volume > 0.0 ? outside_union / volume : 0.0; }
};

/// One object: the meshes of a node, which are the primitives of one glTF mesh.
struct SphereSet {
  std::string name;
  std::vector<int> meshes;            ///< indices into Scene::meshes
  std::vector<int> nodes;             ///< that place it; they share the set
  std::string geometry;               ///< fingerprint of the meshes, 32 hexadecimal digits
  std::vector<Sphere> spheres;        ///< in shape space; empty where the object only receives
  std::string receive_only;           ///< why it casts nothing; empty where it does
  glm::mat3 shape_from_object{1.0f};  ///< not the identity where a node stretches the object unevenly
  bool deforms = false;               ///< skinned or with morph targets: then every sphere has anchors
  std::vector<SphereAnchor> anchors;
  std::vector<std::uint32_t>
      first_anchor;  ///< of each sphere, and one past the end; empty where nothing deforms
  SphereFigures figures;
};

struct SphereOptions {
  int count = 0;           ///< spheres of the whole scene, to 4096; at least one each object that casts. 0: by size and shape
  std::uint32_t seed = 1;  ///< of the search
  int samples = 4000;      ///< points of a surface that lead the search, 500 to 50000
  float effort = 1.0f;     ///< moves of the search, relative to the default, 0.01 to 100
  int threads = 0;         ///< 0: all cores. The result does not depend on it
};

struct SceneSpheres {
  std::vector<SphereSet> sets;
  Warnings warnings;
  int count() const;
};

/// Fits a set to every object of the scene that casts. The number of spheres is spread so that the outside volume of all
/// together is least, by quick fits of 1, 2, 4 … spheres to each; where it is not given, each gets as many as keep that volume
/// below three times its own, 26 to 128 together. Flat things (ground, walls), things
/// without area, and rooms (another object or the camera stands within) only receive. Meshes that are not closed are taken
/// by generalised winding number, sheets that enclose nothing as thick as a grid's cell; inside-out ones are turned. All
/// that is said in `warnings`. Throws Error for options out of range and a scene without triangles, Interrupted when asked
/// to stop.
SceneSpheres bakeSpheres(const Scene& scene, const SphereOptions& options, const Progress& progress = {});

/// A sphere standing in the world.
struct PosedSphere {
  glm::vec3 center{0.0f};
  float radius = 0.0f;
  int set = 0, sphere = 0;  ///< sets[set].spheres[sphere]
  int instance = 0;         ///< of PosedScene::instances: the first mesh of the object that it stands for
  glm::mat3 world_from_shape{1.0f};  ///< orthogonal: how directions of the set's shape space have turned
};

/// All spheres where the objects are. Rigid: by the matrix, radii by its greatest stretch, so that they go on bounding. Skinned
/// and morphed: by the mean rigid motion of a sphere's anchors; it grows or shrinks as they spread, at most to 1.3 times what
/// their mean motion asks for. Throws Error where the sets are not those of the scene.
std::vector<PosedSphere> poseSpheres(const SceneSpheres& spheres, const Scene& scene,
                                     const PosedScene& posed);

/// docs/formats/spheres.md. Writes beside the target and renames.
void writeSpheres(const SceneSpheres& spheres, const std::filesystem::path& path);
/// Throws Error that names the field, also where a set belongs to another geometry than the scene's.
SceneSpheres readSpheres(const std::filesystem::path& path, const Scene& scene);

// ---- Hierarchy (SS-3) -----------------------------------------------------------------------------------------------

/// A tree over spheres. Each node bounds its children; leaves are the spheres given.
struct SphereTree {
  struct Node {
    Sphere bound;
    int first_child = 0, children = 0;  ///< children are neighbours in `nodes`; 0 children: a leaf
    int sphere = kNone;                 ///< of a leaf: index into the spheres given
    int depth = 0;
  };
  std::vector<Node> nodes;  ///< parents before children; the root is the first
};
/// Merges the two groups whose common bounding sphere is smallest, again and again; then takes up grandchildren until each node
/// has `branching` children (2 to 16) or has run out of them.
SphereTree makeSphereTree(std::span<const Sphere> spheres, int branching = 4);
/// New bounds for moved spheres (as many as before); the tree keeps its shape.
void refitSphereTree(SphereTree& tree, std::span<const Sphere> spheres);
/// Nodes that stand for all spheres as seen from anywhere in a cluster of receivers (a ball): the highest whose angular
/// size, sin θ = R / distance from the cluster's nearest point, is at most `sin_limit`; leaves where none is.
std::vector<int> cutSphereTree(const SphereTree& tree, const Sphere& receivers, float sin_limit);
/// The smallest sphere round two.
Sphere boundingSphere(const Sphere& a, const Sphere& b);

}  // namespace gloam
