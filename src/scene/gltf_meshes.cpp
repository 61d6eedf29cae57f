// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Primitives (glTF 2.0 specification, sections 3.7.2 and 5.24; KHR_mesh_quantization). Only vertices that triangles use
// are read: exporters let many primitives share one long vertex array.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image/limits.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_parts.h"
#include "scene/gltf_transfer.h"
#include "scene/mesh_repair.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

class PrimitiveReader {
 public:
  PrimitiveReader(GltfReading& reading, const gloam_tinygltf::Primitive& source, const Json& json,
                  std::string where)
      : reading_(reading),
        document_(reading.document),
        source_(source),
        json_(json),
        where_(std::move(where)) {}

  /// False where nothing is left to draw.
  bool read(Mesh& mesh) {
    const Json* draco = GltfDocument::extension(json_, "KHR_draco_mesh_compression");
    if (draco) draco_ = decodeDraco(document_, source_, *draco, where_);
    position_ = attribute("POSITION", {3});
    readCorners();
    if (corners_.empty()) return false;
    keepUsedVertices(mesh);
    readAttributes(mesh);
    checkPositions(mesh, used_, document_.place(), where_);
    readBakedTransfer(mesh);
    readSkinning(mesh);
    readMorphTargets(mesh);
    return true;
  }

 private:
  /// The view of an attribute; `data` is null where the primitive has none. Throws unless it has as many elements as
  /// POSITION and a number of components from `allowed`.
  AccessorView attribute(const std::string& name, std::initializer_list<int> allowed) {
    const auto known = source_.attributes.find(name);
    if (known == source_.attributes.end()) return {};
    AccessorView view;
    const bool unpacked = draco_ && draco_->attributes.contains(name);
    view = unpacked ? draco_->attributes.at(name) : reading_.accessors.view(known->second);
    checkView(view, known->second, where_ + ".attributes." + name, allowed);
    return view;
  }

  void checkView(const AccessorView& view, int accessor, const std::string& field,
                 std::initializer_list<int> allowed) {
    if (std::find(allowed.begin(), allowed.end(), view.components) == allowed.end())
      document_.fail(field, fmt::format("accessors[{}] has {} components an element, {} were expected",
                                        accessor, view.components, *allowed.begin()));
    if (position_.data && view.count != position_.count)
      document_.fail(field, fmt::format("accessors[{}] has {} elements, but POSITION has {}", accessor,
                                        view.count, position_.count));
    if (view.count > 0xfffffffeu) document_.fail(field, fmt::format("{} vertices are too many", view.count));
  }

  /// The triangles' corners as numbers of vertices in the file.
  void readCorners() {
    std::vector<std::uint32_t> list;
    if (draco_) {
      corners_ = std::move(draco_->indices);
      return checkIndices(corners_);
    }
    if (source_.indices >= 0) {
      const AccessorView view = reading_.accessors.view(source_.indices);
      const std::string field = where_ + ".indices";
      if (view.components != 1 || view.component_type == 5126 || view.component_type == 5120 ||
          view.component_type == 5122)
        document_.fail(field,
                       fmt::format("accessors[{}]: unsigned whole numbers were expected", source_.indices));
      document_.budget.charge(view.count, 4, field);
      list.resize(view.count);
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = view.integer(i, 0);
      checkIndices(list);
    } else {
      document_.budget.charge(position_.count, 4, where_);
      list.resize(position_.count);
      std::iota(list.begin(), list.end(), 0u);
    }
    if (source_.mode == TINYGLTF_MODE_TRIANGLES) {
      if (list.size() % 3 != 0)
        document_.warn(
            fmt::format("{}: {} corners are no whole triangles; the rest is left out", where_, list.size()));
      list.resize(list.size() / 3 * 3);
      corners_ = std::move(list);
      return;
    }
    const std::size_t triangles = list.size() < 3 ? 0 : list.size() - 2;
    document_.budget.charge(triangles, 12, where_);
    corners_.reserve(triangles * 3);
    const bool strip = source_.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    for (std::size_t i = 0; i < triangles; ++i) {
      const std::size_t a = strip ? i : i + 1, b = strip ? i + 1 + i % 2 : i + 2,
                        c = strip ? i + 2 - i % 2 : 0;
      if (list[a] == list[b] || list[b] == list[c] || list[c] == list[a]) continue;  // how strips are joined
      corners_.insert(corners_.end(), {list[a], list[b], list[c]});
    }
  }

  void checkIndices(const std::vector<std::uint32_t>& indices) const {
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= position_.count)
        document_.fail(where_ + ".indices", fmt::format("index {} at {}, but there are {} vertices",
                                                        indices[i], i, position_.count));
  }

  void keepUsedVertices(Mesh& mesh) {
    used_ = corners_;
    std::sort(used_.begin(), used_.end());
    used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    document_.budget.charge(used_.size(), 64 + 36 * source_.targets.size(), where_);
    mesh.indices.reserve(corners_.size());
    const bool all = used_.size() == used_.back() + std::size_t(1);
    for (const std::uint32_t corner : corners_)
      mesh.indices.push_back(all ? corner
                                 : static_cast<std::uint32_t>(
                                       std::lower_bound(used_.begin(), used_.end(), corner) - used_.begin()));
  }

  void readAttributes(Mesh& mesh) {
    mesh.positions = gather<glm::vec3>(position_, used_);
    if (const AccessorView view = attribute("NORMAL", {3}); view.data)
      mesh.normals = gather<glm::vec3>(view, used_);
    if (const AccessorView view = attribute("TANGENT", {4}); view.data)
      mesh.tangents = gather<glm::vec4>(view, used_);
    if (const AccessorView view = attribute("COLOR_0", {4, 3}); view.data) {
      mesh.colors = gather<glm::vec4>(view, used_, glm::vec4(1.0f));
      for (glm::vec4& color : mesh.colors)
        for (int c = 0; c < 4; ++c)
          color[c] = std::isfinite(color[c]) ? std::clamp(color[c], 0.0f, 1e6f) : 1.0f;
    }
    constexpr int kMostUvSets = 8;
    for (int set = 0; set < kMostUvSets; ++set) {
      const AccessorView view = attribute(fmt::format("TEXCOORD_{}", set), {2});
      if (!view.data) continue;
      mesh.uv_sets.resize(static_cast<std::size_t>(set) + 1,
                          std::vector<glm::vec2>(used_.size(), glm::vec2(0.0f)));
      mesh.uv_sets.back() = gather<glm::vec2>(view, used_);
      std::size_t bad = 0;
      for (glm::vec2& uv : mesh.uv_sets.back())
        if (!(std::abs(uv.x) < 1e6f && std::abs(uv.y) < 1e6f)) uv = glm::vec2(0.0f), ++bad;
      if (bad)
        document_.warn(fmt::format(
            "{}: {} texture coordinates were not finite or beyond 1e6 and are set to 0", where_, bad));
    }
  }

  /// It was baked for the file's vertices, also those that no triangle uses.
  void readBakedTransfer(Mesh& mesh) {
    const Json* extension = GltfDocument::extension(json_, kTransferExtension);
    if (!extension) return;
    const std::string field = where_ + ".extensions." + kTransferExtension;
    document_.budget.charge(position_.count, sizeof(glm::vec3) + sizeof(std::uint32_t), field);
    std::vector<std::uint32_t> all(position_.count);
    std::iota(all.begin(), all.end(), 0u);
    const auto uvSet = [&](int set) -> std::optional<std::vector<glm::vec2>> {
      const AccessorView view = attribute(fmt::format("TEXCOORD_{}", set), {2});
      if (!view.data) return std::nullopt;
      return gather<glm::vec2>(view, all);
    };
    const auto transfer = readTransfer(reading_.accessors, *extension, gather<glm::vec3>(position_, all),
                                       corners_, uvSet, field);
    mesh.transfer = used_.size() == position_.count ? transfer : transferOfVertices(*transfer, used_);
  }

  void readSkinning(Mesh& mesh) {
    constexpr int kMostSets = 4;
    std::vector<AccessorView> joints, weights;
    for (int set = 0; set < kMostSets; ++set) {
      const AccessorView j = attribute(fmt::format("JOINTS_{}", set), {4});
      const AccessorView w = attribute(fmt::format("WEIGHTS_{}", set), {4});
      if (!j.data && !w.data) break;
      const std::string field = fmt::format("{}.attributes.JOINTS_{}", where_, set);
      if (!j.data || !w.data)
        document_.fail(field, fmt::format("JOINTS_{0} and WEIGHTS_{0} were expected together", set));
      if (j.component_type == 5126 || j.component_type == 5120 || j.component_type == 5122)
        document_.fail(field, "unsigned whole numbers were expected");
      joints.push_back(j), weights.push_back(w);
    }
    const std::size_t sets = joints.size();
    if (sets == 0) return;
    document_.budget.charge(used_.size(), 24 * sets, where_);
    mesh.influences = static_cast<int>(4 * sets);
    mesh.joints.reserve(used_.size() * 4 * sets);
    mesh.weights.reserve(used_.size() * 4 * sets);
    for (const std::uint32_t vertex : used_)
      for (std::size_t set = 0; set < sets; ++set)
        for (int c = 0; c < 4; ++c) {
          const float weight = weights[set].number(vertex, c);
          const std::uint32_t joint = joints[set].integer(vertex, c);
          if (!std::isfinite(weight) || (joint > 0xffff && weight != 0.0f))
            document_.fail(fmt::format("{}.attributes.WEIGHTS_{}", where_, set),
                           fmt::format("vertex {}: joint {} with weight {}", vertex, joint, weight));
          mesh.weights.push_back(weight);
          mesh.joints.push_back(weight > 0.0f ? static_cast<std::uint16_t>(joint) : std::uint16_t(0));
        }
  }

  void readMorphTargets(Mesh& mesh) {
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      const auto displacements = [&](const char* name, bool has_base) {
        const auto found = source_.targets[t].find(name);
        std::vector<glm::vec3> out;
        if (found == source_.targets[t].end() || !has_base) return out;
        const std::string field = fmt::format("{}.targets[{}].{}", where_, t, name);
        const AccessorView view = reading_.accessors.view(found->second);
        checkView(view, found->second, field, {3});
        out = gather<glm::vec3>(view, used_);
        for (std::size_t i = 0; i < out.size(); ++i)
          if (!(std::abs(out[i].x) < 1e12f && std::abs(out[i].y) < 1e12f && std::abs(out[i].z) < 1e12f))
            document_.fail(field,
                           fmt::format("displacement of vertex {} is not finite or beyond 1e12", used_[i]));
        return out;
      };
      MorphTarget target;
      target.positions = displacements("POSITION", true);
      target.normals = displacements("NORMAL", !mesh.normals.empty());
      target.tangents = displacements("TANGENT", !mesh.tangents.empty());
      mesh.morph_targets.push_back(std::move(target));
    }
  }

  GltfReading& reading_;
  GltfDocument& document_;
  const gloam_tinygltf::Primitive& source_;
  const Json& json_;
  const std::string where_;
  std::optional<DracoPrimitive> draco_;
  AccessorView position_;
  std::vector<std::uint32_t> corners_, used_;
};

int defaultMaterial(GltfReading& reading) {
  if (reading.default_material == kNone) {
    reading.default_material = static_cast<int>(reading.scene.materials.size());
    reading.scene.materials.emplace_back().name = "default";
  }
  return reading.default_material;
}

void readPrimitive(GltfReading& reading, std::size_t mesh_index, std::size_t primitive_index,
                   std::size_t& not_triangles) {
  GltfDocument& document = reading.document;
  const gloam_tinygltf::Mesh& source = document.model.meshes[mesh_index];
  const gloam_tinygltf::Primitive& primitive = source.primitives[primitive_index];
  const Json& json = document.json["meshes"][mesh_index]["primitives"][primitive_index];
  const std::string where = source.name.empty()
                                ? fmt::format("meshes[{}].primitives[{}]", mesh_index, primitive_index)
                                : fmt::format("meshes[{}] ('{}').primitives[{}]", mesh_index,
                                              oneLine(source.name), primitive_index);
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    ++not_triangles;
    return;
  }
  if (!primitive.attributes.contains("POSITION"))
    return document.warn(where + ": has no POSITION and is left out");

  Mesh mesh;
  mesh.name = source.name.empty() ? fmt::format("mesh {}", mesh_index) : source.name;
  mesh.material = primitive.material >= 0 ? primitive.material : defaultMaterial(reading);
  if (!PrimitiveReader(reading, primitive, json, where).read(mesh)) return;
  const Material& material = reading.scene.materials[static_cast<std::size_t>(mesh.material)];
  const bool visible = finishMesh(mesh, material, kFlat, where, reading.repairs);
  if (!visible) return;
  reading.meshes_of[mesh_index].push_back(static_cast<int>(reading.scene.meshes.size()));
  reading.scene.meshes.push_back(std::move(mesh));
}

}  // namespace

void readMeshes(GltfReading& reading) {
  const auto& meshes = reading.document.model.meshes;
  reading.meshes_of.resize(meshes.size());
  std::size_t not_triangles = 0;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t p = 0; p < meshes[m].primitives.size(); ++p) {
      reading.step(0.3 + 0.6 * static_cast<double>(m) / static_cast<double>(meshes.size()), "reading meshes");
      readPrimitive(reading, m, p, not_triangles);
    }
  for (const std::string& line : reading.repairs.lines()) reading.document.warn(line);
  if (not_triangles)
    reading.document.warn(fmt::format("{} primitives are points or lines and are left out", not_triangles));
}

}  // namespace gloam
