// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where everything is in this frame, and where it was in the last.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

#include "frame/gpu_scene.h"
#include "math/box.h"
#include "scene/transforms.h"

namespace gloam::frame {

namespace {

Box worldBox(const Instance& instance, const GpuMesh& mesh) {
  Box box;
  if (instance.deformed()) {
    for (const glm::vec3& p : instance.deformed_positions) box.add(p);
    return box;
  }
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? mesh.bounds_max.x : mesh.bounds_min.x,
                      corner & 2 ? mesh.bounds_max.y : mesh.bounds_min.y,
                      corner & 4 ? mesh.bounds_max.z : mesh.bounds_min.z);
    box.add(glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f)));
  }
  return box;
}

}  // namespace

bool isOutside(const DrawRange& range, const glm::mat4& clip_from_world) {
  std::array<int, 6> outside{};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? range.bounds_max.x : range.bounds_min.x,
                      corner & 2 ? range.bounds_max.y : range.bounds_min.y,
                      corner & 4 ? range.bounds_max.z : range.bounds_min.z);
    const glm::vec4 clip = clip_from_world * glm::vec4(p, 1.0f);
    const std::array<bool, 6> sides = {clip.x > clip.w, clip.x<-clip.w, clip.y> clip.w,
                                       clip.y<-clip.w, clip.z> clip.w, clip.z < 0.0f};
    for (std::size_t side = 0; side < sides.size(); ++side) outside[side] += sides[side];
  }
  return std::any_of(outside.begin(), outside.end(), [](int count) { return count == 8; });
}

void GpuScene::checkPose(const PosedScene& posed) const {
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const Instance& instance = posed.instances[i];
    const std::string place = fmt::format("instances[{}]", i);
    if (instance.mesh < 0 || std::size_t(instance.mesh) >= meshes_.size())
      throw Error(place,
                  fmt::format("mesh {}; the scene that was set has {}", instance.mesh, meshes_.size()));
    if (!instance.deformed()) continue;
    const std::size_t count = meshes_[std::size_t(instance.mesh)].vertex_count;
    if (instance.deformed_positions.size() != count || instance.deformed_normals.size() != count)
      throw Error(place,
                  fmt::format("{} deformed positions and {} normals for a mesh of {} vertices",
                              instance.deformed_positions.size(), instance.deformed_normals.size(), count));
  }
}

void GpuScene::growVertices(std::size_t count) {
  if (positions_.bytes() >= count * sizeof(glm::vec3)) return;
  const auto grow = [&](gpu::Buffer& buffer, std::size_t stride) {
    gpu::Buffer larger(device_, buffer.name(), gpu::BufferDesc{.bytes = count * stride});
    const std::vector<std::byte> old = buffer.download<std::byte>();
    larger.uploadBytes(std::span(old).first(static_vertices_ * stride));
    buffer = std::move(larger);
  };
  grow(positions_, sizeof(glm::vec3));
  grow(normals_, sizeof(glm::vec3));
  grow(tangents_, sizeof(glm::vec4));
}

void GpuScene::layOut(const PosedScene& posed) {
  std::vector<Kind> layout;
  for (const Instance& instance : posed.instances) layout.push_back({instance.mesh, instance.deformed()});
  if (layout == layout_ && layout_revision_ > 0) return;
  layout_ = std::move(layout);
  static std::atomic<std::uint64_t> last_revision{0};
  layout_revision_ = ++last_revision;
  has_previous_ = false;
  deformed_vertices_ = 0;
  for (const Kind& kind : layout_) {
    if (kind.deformed) deformed_vertices_ += meshes_[std::size_t(kind.mesh)].vertex_count;
  }
  growVertices(static_vertices_ + 2 * std::size_t(deformed_vertices_));

  // Rigid instances of one mesh are drawn together, opaque ones first; deformed ones each have vertices of
  // their own.
  order_.resize(layout_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    return std::tuple(meshes_[std::size_t(layout_[i].mesh)].alpha_mask, layout_[i].deformed, layout_[i].mesh);
  };
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
}

void GpuScene::makeRows(const PosedScene& posed) {
  const std::vector<InstanceRow> last = std::move(rows_);
  rows_.assign(posed.instances.size(), {});
  std::uint32_t next_deformed = static_vertices_ + turn_ * deformed_vertices_;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Instance& instance = posed.instances[i];
    const GpuMesh& mesh = meshes_[std::size_t(instance.mesh)];
    InstanceRow& row = rows_[i];
    row.world_from_object = glm::mat4x3(instance.deformed() ? glm::mat4(1.0f) : instance.world_from_object);
    const glm::mat3 linear(row.world_from_object);
    row.world_from_normal = normalTransform(linear);
    row.handedness = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
    row.mesh = static_cast<std::uint32_t>(instance.mesh);
    row.first_vertex = instance.deformed() ? next_deformed : mesh.row.first_vertex;
    if (instance.deformed()) next_deformed += mesh.vertex_count;
    row.previous_world_from_object = has_previous_ ? last[i].world_from_object : row.world_from_object;
    row.previous_first_vertex = has_previous_ ? last[i].first_vertex : row.first_vertex;
  }
}

void GpuScene::updateDraws(const PosedScene& posed) {
  draws_.clear();
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    const Kind kind = layout_[order_[place]];
    const GpuMesh& mesh = meshes_[std::size_t(kind.mesh)];
    if (mesh.index_count == 0) continue;
    Box box = worldBox(posed.instances[order_[place]], mesh);
    if (!draws_.empty() && !kind.deformed && draws_.back().mesh == std::uint32_t(kind.mesh)) {
      DrawRange& range = draws_.back();
      ++range.count;
      box.add({range.bounds_min, range.bounds_max});
    } else {
      draws_.push_back({std::uint32_t(kind.mesh), place, 1, {}, {}});
    }
    draws_.back().bounds_min = box.low;
    draws_.back().bounds_max = box.high;
  }
  Box all;
  for (const DrawRange& range : draws_) all.add({range.bounds_min, range.bounds_max});
  if (draws_.empty()) all = {glm::vec3(0.0f), glm::vec3(0.0f)};
  bounds_min_ = all.low;
  bounds_max_ = all.high;
}

void GpuScene::copyDeformed(gpu::FrameGraph& graph, const PosedScene& posed) {
  if (deformed_vertices_ == 0) return;
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  for (const Instance& instance : posed.instances) {
    if (!instance.deformed()) continue;
    positions.insert(positions.end(), instance.deformed_positions.begin(), instance.deformed_positions.end());
    normals.insert(normals.end(), instance.deformed_normals.begin(), instance.deformed_normals.end());
    if (instance.deformed_tangents.size() == instance.deformed_positions.size())
      tangents.insert(tangents.end(), instance.deformed_tangents.begin(), instance.deformed_tangents.end());
    tangents.resize(positions.size(), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
  const std::size_t first = static_vertices_ + std::size_t(turn_) * deformed_vertices_;
  const auto copy = [&](const std::string& name, const auto& values, const gpu::Buffer& to) {
    const std::size_t stride = sizeof(values[0]);
    graph.copy("frame.pose", graph.upload(name, values),
               gpu::BufferRef(to).slice(first * stride, values.size() * stride));
  };
  copy("frame.deformed_positions", positions, positions_);
  copy("frame.deformed_normals", normals, normals_);
  copy("frame.deformed_tangents", tangents, tangents_);
}

void GpuScene::pose(gpu::FrameGraph& graph, const PosedScene& posed) {
  checkPose(posed);
  layOut(posed);
  turn_ = has_previous_ ? 1 - turn_ : 0;
  makeRows(posed);
  carriers_.pose(posed);
  volumes_ = volume_places_.at(posed.time_s);
  updateDraws(posed);
  copyDeformed(graph, posed);
  has_previous_ = true;
  instance_rows_ = graph.upload("frame.instances", rows_);
  draw_order_ = graph.upload("frame.draw_order", order_);
}

}  // namespace gloam::frame
