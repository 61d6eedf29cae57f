// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake will take. Memory is that of the greatest of three moments: passes, attaching transfer, writing; hits that are
// kept between passes are foretold by a few rays from some of the points.
#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_apart.h"
#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_bake_plan.h"
#include "techniques/prt/prt_bake_texels.h"

namespace gloam {
namespace prt {
namespace {

/// Libraries at work: the ray tracer's device, threads' stacks and arenas, blocks under way. Measured.
constexpr std::size_t kWorkBytes = std::size_t(14) << 20;
/// A triangle in the hierarchy, with what it is built from. Measured.
constexpr std::size_t kHierarchyBytes = 150;

/// Counted sizes of a bake.
struct BakeSizes {
  PosedScene posed;
  BakePoints points;  ///< of vertices
  std::vector<LightmapSize> lightmaps;
  std::vector<std::uint8_t> glossy;  ///< by instance
  std::size_t vertices = 0, triangles = 0, texels = 0, glossy_vertices = 0;
  std::size_t all_points = 0;   ///< welded vertices and covered texels
  std::size_t file_points = 0;  ///< vertices, or all texels of a lightmap
  std::size_t written_mesh_bytes = 0;
  std::size_t mesh_bytes = 0;  ///< of unique copies
  std::size_t texture_bytes = 0;
  double largest_object = 1.0;  ///< its share of all vertices, where objects are baked apart
  std::vector<int> objects;     ///< by node, where objects are baked apart; else empty
  bool mirrors = false;
};

/// As writeGlb has it: short indices where they suffice, tangents where a normal map needs them.
std::size_t writtenBytes(const Scene& scene, const Mesh& mesh) {
  std::size_t vertex =
      sizeof(glm::vec3) * (mesh.normals.empty() ? 1 : 2) + sizeof(glm::vec2) * mesh.uv_sets.size();
  if (!mesh.tangents.empty() && scene.materials[std::size_t(mesh.material)].normal_map)
    vertex += sizeof(glm::vec4);
  if (!mesh.colors.empty()) vertex += sizeof(glm::vec4);
  vertex += std::size_t(mesh.influences) * 6 + mesh.morph_targets.size() * 2 * sizeof(glm::vec3);
  return mesh.vertexCount() * vertex + mesh.indices.size() * (mesh.vertexCount() < 0xffffu ? 2 : 4);
}

std::size_t bytesOf(const Mesh& mesh) {
  std::size_t vertex =
      sizeof(glm::vec3) * (mesh.normals.empty() ? 1 : 2) + sizeof(glm::vec2) * mesh.uv_sets.size();
  if (!mesh.tangents.empty()) vertex += sizeof(glm::vec4);
  if (!mesh.colors.empty()) vertex += sizeof(glm::vec4);
  return mesh.vertexCount() * vertex + mesh.indices.size() * sizeof(std::uint32_t);
}

void countObjects(const Scene& scene, BakeSizes& sizes) {
  sizes.objects = objectsOfNodes(scene, sizes.posed);
  std::vector<std::size_t> vertices;
  for (const Instance& instance : sizes.posed.instances) {
    const int number = sizes.objects[std::size_t(instance.node)];
    if (number == kNone) continue;
    vertices.resize(std::max(vertices.size(), std::size_t(number) + 1));
    vertices[std::size_t(number)] += scene.meshes[std::size_t(instance.mesh)].vertexCount();
  }
  if (!vertices.empty() && sizes.vertices > 0)
    sizes.largest_object = std::min(1.0, double(std::ranges::max(vertices)) / double(sizes.vertices));
}

BakeSizes countSizes(const Scene& scene, const BakeOptions& options) {
  BakeSizes sizes;
  sizes.posed = pose(scene, options.time_s);
  sizes.points = makeBakePoints(scene, sizes.posed);
  sizes.glossy = glossyInstances(scene, sizes.posed, options.glossy);
  sizes.mirrors = followsMirrors(scene, sizes.posed, options);
  Warnings unused;
  if (wantsTexels(options)) {
    sizes.texels = countTexels(scene, sizes.posed, options);
    sizes.lightmaps = chooseLightmaps(scene, sizes.posed, options, unused);
  }
  for (std::size_t i = 0; i < sizes.posed.instances.size(); ++i) {
    const Instance& instance = sizes.posed.instances[i];
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    sizes.mesh_bytes += bytesOf(mesh);
    sizes.written_mesh_bytes += writtenBytes(scene, mesh);
    if (instance.deformed() || mesh.indices.empty()) continue;
    sizes.vertices += mesh.vertexCount();
    sizes.triangles += mesh.triangleCount();
    if (sizes.glossy[i]) sizes.glossy_vertices += mesh.vertexCount();
    const LightmapSize map = sizes.lightmaps.empty() ? LightmapSize{} : sizes.lightmaps[i];
    sizes.file_points +=
        map.width > 0 ? std::size_t(map.width) * std::size_t(map.height) : mesh.vertexCount();
  }
  for (const Texture& texture : scene.textures) sizes.texture_bytes += texture.rgba.size();
  sizes.all_points = sizes.points.size() + sizes.texels;
  if (options.apart) countObjects(scene, sizes);
  return sizes;
}

/// Numbers of transfer in the file: diffuse, and those of matrices.
struct FileNumbers {
  std::size_t diffuse = 0, glossy = 0;
};
FileNumbers numbersOf(const BakeSizes& sizes, const BakeOptions& options) {
  const bool bounces = bouncesOf(options) > 0;
  const std::size_t coefficients = std::size_t(options.order * options.order);
  const GlossyLayout layout = glossyLayout(options);
  const std::size_t matrix = std::size_t(layout.lightCount() * layout.fieldCount());
  return {sizes.file_points * coefficients * (bounces ? 4 : 1),
          sizes.glossy_vertices * (layout.visibilityCount() + (bounces ? 3 * matrix : 0))};
}

/// As compressTransfer will have it.
std::size_t compressedBytes(const Scene& scene, const BakeSizes& sizes, const BakeOptions& options,
                            const BakeFileForm& form) {
  constexpr std::size_t kPointsANumber = 2;
  const std::size_t width = std::size_t(options.order * options.order) * (bouncesOf(options) > 0 ? 4 : 1);
  const std::size_t vectors = std::min(std::size_t(form.vectors), width), number = form.half_float ? 2 : 4;
  std::size_t points = 0;
  for (std::size_t i = 0; i < sizes.posed.instances.size(); ++i) {
    const Instance& instance = sizes.posed.instances[i];
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (instance.deformed() || mesh.indices.empty()) continue;
    const LightmapSize map = sizes.lightmaps.empty() ? LightmapSize{} : sizes.lightmaps[i];
    points += map.width > 0 ? std::size_t(map.width) * std::size_t(map.height) : mesh.vertexCount();
  }
  const std::size_t clusters =
      std::clamp<std::size_t>(points / (kPointsANumber * width), 1, std::size_t(form.clusters));
  return clusters * (1 + vectors) * width * number + points * (vectors * number + (clusters > 256 ? 2 : 1));
}

/// JSON, meshes and pictures come with a margin: what pictures shrink to is not known before.
std::size_t fileBytes(const Scene& scene, const BakeSizes& sizes, const BakeOptions& options,
                      const BakeFileForm& form) {
  const FileNumbers numbers = numbersOf(sizes, options);
  const std::size_t number = form.half_float ? 2 : 4;
  const std::size_t diffuse =
      form.clusters > 0 ? compressedBytes(scene, sizes, options, form) : numbers.diffuse * number;
  const std::size_t text =
      4096 + 2048 * (sizes.posed.instances.size() + scene.nodes.size() + scene.materials.size());
  return diffuse + numbers.glossy * number + sizes.written_mesh_bytes + sizes.texture_bytes / 2 + text;
}

/// Without hits that are kept.
std::size_t leastOf(const Scene& scene, const BakeSizes& sizes, const BakeOptions& options,
                    const BakeFileForm& form) {
  const bool bounces = bouncesOf(options) > 0;
  const DirectionTables tables = tablesFor(options);
  const FileNumbers numbers = numbersOf(sizes, options);
  const std::size_t transfer = (numbers.diffuse + numbers.glossy) * sizeof(float);
  const GlossyLayout layout = glossyLayout(options);
  const auto ofObject = [&](std::size_t bytes) { return std::size_t(sizes.largest_object * double(bytes)); };
  // Positions, normals, lists of triangles; the table that welds is gone by then.
  const std::size_t points = ofObject(sizes.all_points * 2 * sizeof(glm::vec3) + sizes.vertices * 4 +
                                      sizes.triangles * 30 + sizes.texels * (sizeof(FacePoint) + 16));
  std::size_t state = bakeStateBytes(sizes.all_points, tables, bouncesOf(options), sizes.mirrors) +
                      sizes.all_points * 4 * (sizes.glossy_vertices > 0);
  std::size_t of_glossy = sizes.glossy_vertices * glossyStateBytes(layout, bounces),
              fixed = tables.memoryBytes();
  if (sizes.glossy_vertices > 0) fixed += GlossyTables::memoryBytes(layout, tables.tiles);
  const std::size_t copies = (options.apart ? 2 : 1) * (sizes.mesh_bytes + sizes.texture_bytes);
  const std::size_t passes = points + ofObject(state + of_glossy + sizes.triangles * kHierarchyBytes) +
                             fixed + (options.apart ? transfer : 0);
  const std::size_t attaching = points + ofObject(state / 2 + of_glossy / 2) + fixed + transfer;
  const std::size_t written = fileBytes(scene, sizes, options, form);
  const std::size_t writing =
      transfer + 2 * written + (form.half_float ? written : 0) + (form.clusters > 0 ? transfer : 0);
  return kWorkBytes + copies + std::max({passes, attaching, writing});
}

/// By point, an instance that it is a vertex of.
std::vector<std::uint32_t> ownersOf(const Scene& scene, const BakeSizes& sizes) {
  std::vector<std::uint32_t> owner(sizes.points.size(), 0);
  for (std::size_t i = 0; i < sizes.posed.instances.size(); ++i) {
    const Instance& instance = sizes.posed.instances[i];
    if (instance.deformed()) continue;
    const std::size_t first = sizes.points.first_vertex[i];
    const std::size_t count = scene.meshes[std::size_t(instance.mesh)].vertexCount();
    for (std::size_t v = first; v < std::min(first + count, sizes.points.point_of_vertex.size()); ++v) {
      const std::uint32_t point = sizes.points.point_of_vertex[v];
      if (point != BakePoints::kNoPoint) owner[point] = std::uint32_t(i);
    }
  }
  return owner;
}

/// Bytes of kept hits a direction that a point asks bounce passes for, at most: the mean over some points and three standard
/// errors of it.
double hitBytes(const Scene& scene, const BakeSizes& sizes) {
  constexpr std::size_t kPoints = 1024, kRays = 64;
  const double hit = sizes.glossy_vertices > 0 ? sizeof(GlossyHit) : sizeof(GatheredHit);
  const trace::Tracer tracer(scene, sizes.posed, {.rigid_only = true});
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(int(kRays));
  const std::size_t count = std::min(kPoints, sizes.points.size());
  std::vector<double> of_instance;
  for (const Instance& instance : sizes.posed.instances) {
    const Material& material =
        scene.materials[std::size_t(scene.meshes[std::size_t(instance.mesh)].material)];
    const bool mirror = sizes.mirrors && greatestSpecular(scene, material) >= kShinySpecular;
    const bool metal = material.metallic == 1.0f && !material.metallic_roughness_map;  // nothing is diffuse
    of_instance.push_back((mirror && metal ? 0.0 : hit) +
                          (mirror ? std::max(hit, double(sizeof(SkyHit))) : 0.0));
  }
  const std::vector<std::uint32_t> owner = ownersOf(scene, sizes);
  const auto object_of = [&](std::size_t instance) {
    return sizes.objects.empty() ? 0 : sizes.objects[std::size_t(sizes.posed.instances[instance].node)];
  };
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t point = k * sizes.points.size() / count;
    const glm::vec3 origin = rayOrigin(sizes.points, point), normal = sizes.points.normals[point];
    double bytes = 0.0;
    for (const glm::vec3& direction : directions) {
      if (!(glm::dot(direction, normal) > 0.0f)) continue;
      const trace::Hit found = tracer.closest({.origin = origin, .direction = direction});
      if (!found) continue;
      const std::size_t instance = std::size_t(found.instance);
      const std::size_t t = sizes.points.first_triangle[instance] + std::size_t(found.triangle);
      if (glm::dot(direction, found.geometric_normal) * float(sizes.points.facing[t]) > 0.0f) continue;
      if (object_of(instance) != object_of(owner[point])) continue;  // they do not see each other
      bytes += of_instance[instance];
    }
    bytes /= double(kRays);
    sum += bytes;
    squares += bytes * bytes;
  }
  const double n = double(std::max<std::size_t>(1, count)), mean = sum / n;
  const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean));
  return mean + 3.0 * deviation / std::sqrt(n) + 0.002 * hit;
}

std::size_t keptBytes(const Scene& scene, const BakeSizes& sizes, const BakeOptions& options) {
  constexpr std::size_t kNotWorthAsking = std::size_t(4) << 20, kMostTriangles = 4000000;
  const DirectionTables tables = tablesFor(options);
  const double hit = sizes.glossy_vertices > 0 ? sizeof(GlossyHit) : sizeof(GatheredHit);
  const double directions =
      double(sizes.all_points) * sizes.largest_object * double(tables.bounce_tiles) * kTileSize;
  const double most = 0.5 * directions * (hit + (sizes.mirrors ? sizeof(SkyHit) : 0.0));
  if (most < double(kNotWorthAsking) || sizes.triangles > kMostTriangles) return std::size_t(most);
  return std::size_t(std::min(most, directions * hitBytes(scene, sizes)));
}

}  // namespace

std::size_t leastMemory(const Scene& scene, const BakeOptions& options) {
  return leastOf(scene, countSizes(scene, options), options, {});
}

}  // namespace prt

using namespace prt;

BakeEstimate estimateBake(const Scene& scene, const BakeOptions& given, const BakeFileForm& form) {
  checkOptions(given);
  const BakeOptions options = withBounceDirections(scene, given);
  const BakeSizes sizes = countSizes(scene, options);
  BakeEstimate estimate{.vertices = sizes.vertices,
                        .triangles = sizes.triangles,
                        .glossy_vertices = sizes.glossy_vertices,
                        .texels = sizes.texels};
  if (options.kind != TransferKind::kUnshadowed)
    estimate.rays = sizes.all_points * std::size_t(tablesFor(options).tiles) * kTileSize / 2;
  estimate.file_bytes = fileBytes(scene, sizes, options, form);
  estimate.least_memory_bytes = estimate.memory_bytes = leastOf(scene, sizes, options, form);
  if (bouncesOf(options) > 1) {
    std::size_t most = kKeptHitsBytes;
    if (options.memory_bytes > 0)
      most =
          std::min(most, options.memory_bytes - std::min(options.memory_bytes, estimate.least_memory_bytes));
    estimate.memory_bytes += std::min(most, keptBytes(scene, sizes, options));
  }
  return estimate;
}

}  // namespace gloam
