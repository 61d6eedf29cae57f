// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The scene as the device sees it: vertices, materials and textures once, instances every frame.
#pragma once

#include <gloam/scene.h>

#include "frame/carriers.h"
#include "frame/frame_shared.h"
#include "frame/textures.h"
#include "gpu/frame_graph.h"
#include "scene/volume_places.h"

namespace gloam::frame {

/// What the host keeps of a mesh.
struct GpuMesh {
  std::string name;
  MeshRow row{};
  std::uint32_t vertex_count = 0, index_count = 0;
  bool textured = false, alpha_mask = false, vertex_colors = false;
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
  std::shared_ptr<const Transfer> transfer;   ///< null unless baked
  std::uint32_t first_lightmap_uv = kAbsent;  ///< in uvs(), of transfer that is of texels
};

/// Instances of one mesh that are drawn together: places first_place … in the order of drawing.
struct DrawRange {
  std::uint32_t mesh = 0, first_place = 0, count = 0;
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};  ///< in the world
};

/// True where its box lies wholly outside one of a view's sides (tested in clip space, w > 0 or not).
bool isOutside(const DrawRange& range, const glm::mat4& clip_from_world);

class GpuScene {
 public:
  /// Uploads what does not change. Throws Error for a mesh without normals, and where data exceeds what a
  /// buffer of this device holds.
  GpuScene(gpu::Device& device, const Scene& scene);

  /// Puts the instances where they are now; what they were in the last call is their previous pose. Adds
  /// passes that copy deformed vertices. Throws Error where `posed` does not fit the scene.
  void pose(gpu::FrameGraph& graph, const PosedScene& posed);

  const std::vector<GpuMesh>& meshes() const { return meshes_; }
  const Textures& textures() const { return textures_; }
  /// Of the last pose(), by object id - 1.
  const std::vector<InstanceRow>& instances() const { return rows_; }
  const std::vector<DrawRange>& draws() const { return draws_; }
  /// Nodes that carry neighbourhood transfer, where they were at the last pose().
  const Carriers& carriers() const { return carriers_; }
  /// Of the last pose().
  const std::vector<PlacedVolume>& volumes() const { return volumes_; }
  /// The instance that stands at a place of the order of drawing.
  std::uint32_t instanceAt(std::uint32_t place) const { return order_[place]; }
  bool deformed(std::size_t instance) const { return rows_[instance].first_vertex >= static_vertices_; }
  glm::vec3 boundsMin() const { return bounds_min_; }
  glm::vec3 boundsMax() const { return bounds_max_; }
  /// Another number for every set of instances, of any scene: techniques that see a new one make anew what
  /// they hold an instance. Poses of the same instances keep it.
  std::uint64_t layoutRevision() const { return layout_revision_; }

  // Bindings by these names: positions, normals, tangents, uvs, colors, indices, meshes, instances,
  // draw_order; a draw's own are `material` (a uniform block) and the maps.
  gpu::BufferRef positions() const { return positions_; }
  gpu::BufferRef normals() const { return normals_; }
  gpu::BufferRef indices() const { return indices_; }
  gpu::BufferRef uvs() const { return uvs_; }
  gpu::BufferRef instanceRows() const { return instance_rows_; }
  gpu::BufferRef meshRows() const { return mesh_rows_; }
  /// The MaterialRow of one material.
  gpu::BufferRef material(std::uint32_t index) const {
    return gpu::BufferRef(material_rows_).slice(std::size_t(index) * kMaterialStride, sizeof(MaterialRow));
  }
  /// Binds what a vertex shader pulls to find its place: positions, instances, draw_order.
  template <class Pass>
  Pass& bindPlaces(Pass& pass) const {
    return pass.read("positions", positions_)
        .read("instances", instance_rows_)
        .read("draw_order", draw_order_);
  }
  /// Binds the rest of what the G-buffer pulls: normals, tangents, uvs, colors, meshes.
  template <class Pass>
  Pass& bindSurface(Pass& pass) const {
    return pass.read("normals", normals_)
        .read("tangents", tangents_)
        .read("uvs", uvs_)
        .read("colors", colors_)
        .read("meshes", mesh_rows_);
  }
  /// Binds what is needed to find a triangle's corners: positions, indices, instances, meshes.
  template <class Pass>
  Pass& bindTriangles(Pass& pass) const {
    return pass.read("positions", positions_)
        .read("indices", indices_)
        .read("instances", instance_rows_)
        .read("meshes", mesh_rows_);
  }
  /// Binds what the holes of a surface need: uvs, colors, meshes.
  template <class Pass>
  Pass& bindMask(Pass& pass) const {
    return pass.read("uvs", uvs_).read("colors", colors_).read("meshes", mesh_rows_);
  }

 private:
  static constexpr std::size_t kMaterialStride = 256;  ///< where uniform blocks may begin on any device
  struct Kind {
    int mesh;
    bool deformed;
    bool operator==(const Kind&) const = default;
  };
  void checkPose(const PosedScene& posed) const;
  void layOut(const PosedScene& posed);
  void makeRows(const PosedScene& posed);
  void updateDraws(const PosedScene& posed);
  void copyDeformed(gpu::FrameGraph& graph, const PosedScene& posed);
  void growVertices(std::size_t count);

  gpu::Device& device_;
  Textures textures_;
  Carriers carriers_;
  VolumePlaces volume_places_;
  std::vector<PlacedVolume> volumes_;
  std::vector<GpuMesh> meshes_;
  gpu::Buffer positions_, normals_, tangents_, uvs_, colors_, indices_, mesh_rows_, material_rows_;
  std::uint32_t static_vertices_ = 0;

  std::vector<Kind> layout_;
  std::uint64_t layout_revision_ = 0;
  std::uint32_t deformed_vertices_ = 0;  // of one pose; two stand behind the static ones, taking turns
  std::uint32_t turn_ = 0;
  bool has_previous_ = false;
  std::vector<InstanceRow> rows_;
  std::vector<std::uint32_t> order_;
  std::vector<DrawRange> draws_;
  glm::vec3 bounds_min_{0.0f}, bounds_max_{0.0f};
  gpu::BufferRef instance_rows_, draw_order_;  // of this frame
};

}  // namespace gloam::frame
