// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// assimp's node tree, cameras, lights and animation.
#if GLOAM_HAS_ASSIMP
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/assimp_parts.h"
#include "scene/transforms.h"

namespace gloam {
namespace {

bool usable(const glm::mat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(m[column][row]) <= 1e12f)) return false;
  return true;
}

/// A child of the named node (of the root where there is none) that stands at `position` and looks along -Z to `forward`.
Node& addLookingNode(Scene& scene, const AssimpNodes& nodes, const std::string& name,
                     const glm::vec3& position, const glm::vec3& forward, const glm::vec3& up) {
  const auto parent = nodes.by_name.find(name);
  const int index = static_cast<int>(scene.nodes.size());
  const int parent_index = parent == nodes.by_name.end() ? 0 : parent->second;
  Node node;
  node.name = name;
  node.parent = parent_index;
  node.translation = usable(glm::mat4(glm::vec4(position, 0), glm::vec4(0), glm::vec4(0), glm::vec4(0)))
                         ? position
                         : glm::vec3(0);
  if (glm::length(forward) > 1e-6f) {
    const glm::vec3 back = -glm::normalize(forward);
    glm::vec3 side = glm::cross(up, back);
    if (!(glm::length(side) > 1e-4f))
      side = glm::cross(std::abs(back.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0), back);
    side = glm::normalize(side);
    node.rotation = glm::normalize(glm::quat_cast(glm::mat3(side, glm::cross(back, side), back)));
  }
  scene.nodes[static_cast<std::size_t>(parent_index)].children.push_back(index);
  return scene.nodes.emplace_back(std::move(node));
}

}  // namespace

AssimpNodes readAssimpNodes(const aiScene& source, Scene& scene) {
  constexpr std::size_t kMostNodes = 1000000;
  AssimpNodes out;
  out.users_of_mesh.resize(source.mNumMeshes);
  std::vector<std::pair<const aiNode*, int>> open = {{source.mRootNode, kNone}};
  for (std::size_t at = 0; at < open.size(); ++at) {
    const auto [from, parent] = open[at];
    const int index = static_cast<int>(scene.nodes.size());
    if (scene.nodes.size() > kMostNodes) throw Error("more than a million nodes");
    Node node;
    node.name = from->mName.C_Str();
    node.parent = parent;
    const glm::mat4 matrix = toGlm(from->mTransformation);
    if (!usable(matrix)) throw Error(fmt::format("node '{}': its matrix is not finite", node.name));
    if (matrix != glm::mat4(1.0f)) node.matrix = matrix;
    scene.nodes.push_back(std::move(node));
    if (parent != kNone) scene.nodes[static_cast<std::size_t>(parent)].children.push_back(index);
    out.by_name.emplace(from->mName.C_Str(), index);
    for (unsigned m = 0; m < from->mNumMeshes; ++m)
      if (from->mMeshes[m] < source.mNumMeshes) out.users_of_mesh[from->mMeshes[m]].push_back(index);
    for (unsigned c = 0; c < from->mNumChildren; ++c) open.emplace_back(from->mChildren[c], index);
  }
  scene.roots = {0};
  return out;
}

namespace {

/// Metres in the unit in which an FBX file counts; lengths are in metres already (aiProcess_GlobalScale), the fading of its
/// lamps is not. 1 for other formats.
float fileUnit(const aiScene& source) {
  double centimetres = 100.0;
  float single = 0.0f;
  if (source.mMetaData == nullptr) return 1.0f;
  if (source.mMetaData->Get("UnitScaleFactor", single)) {
    centimetres = double(single);
  } else if (!source.mMetaData->Get("UnitScaleFactor", centimetres)) {
    return 1.0f;
  }
  return std::isfinite(centimetres) && centimetres > 0.0 ? float(0.01 * centimetres) : 1.0f;
}

}  // namespace

void readAssimpCamerasAndLights(const aiScene& source, const AssimpNodes& nodes, Scene& scene) {
  const float unit_m = fileUnit(source);
  for (unsigned i = 0; i < source.mNumCameras; ++i) {
    const aiCamera& from = *source.mCameras[i];
    Camera camera;
    camera.name = from.mName.C_Str();
    camera.aspect =
        std::isfinite(from.mAspect) && from.mAspect > 0.01f && from.mAspect < 100.0f ? from.mAspect : 0.0f;
    const float half = std::clamp(from.mHorizontalFOV, 0.01f, 3.1f) / 2.0f;
    if (std::isfinite(half))
      camera.vertical_fov_rad =
          2.0f * std::atan(std::tan(half) / (camera.aspect > 0.0f ? camera.aspect : 1.0f));
    if (from.mClipPlaneNear > 0.0f && std::isfinite(from.mClipPlaneNear)) camera.z_near = from.mClipPlaneNear;
    addLookingNode(scene, nodes, camera.name, toGlm(from.mPosition), toGlm(from.mLookAt), toGlm(from.mUp))
        .camera = static_cast<int>(scene.cameras.size());
    scene.cameras.push_back(std::move(camera));
  }
  for (unsigned i = 0; i < source.mNumLights; ++i) {
    const aiLight& from = *source.mLights[i];
    Light light;
    light.name = from.mName.C_Str();
    if (from.mType == aiLightSource_DIRECTIONAL)
      light.type = Light::Type::kDirectional;
    else if (from.mType == aiLightSource_SPOT)
      light.type = Light::Type::kSpot;
    else if (from.mType != aiLightSource_POINT)
      continue;  // ambient light has no place here
    light.intensity = glm::vec3(from.mColorDiffuse.r, from.mColorDiffuse.g, from.mColorDiffuse.b);
    if (light.type != Light::Type::kDirectional && from.mAttenuationQuadratic > 1e-12f) {
      light.intensity *=
          unit_m * unit_m / from.mAttenuationQuadratic;  // it counts in the file's unit of length
    } else if (light.type != Light::Type::kDirectional) {
      scene.warnings.push_back(fmt::format(
          "lamp '{}' does not fade with the square of the distance as lamps do here: its strength "
          "is a guess",
          light.name));
    }
    for (int c = 0; c < 3; ++c)
      light.intensity[c] =
          std::isfinite(light.intensity[c]) ? std::clamp(light.intensity[c], 0.0f, 1e30f) : 0.0f;
    const float outer = from.mAngleOuterCone / 2.0f, inner = from.mAngleInnerCone / 2.0f;
    if (outer > 0.0f && outer < std::numbers::pi_v<float> / 2.0f) light.outer_cone_rad = outer;
    light.inner_cone_rad =
        inner >= 0.0f && inner < light.outer_cone_rad ? inner : 0.999f * light.outer_cone_rad;
    addLookingNode(scene, nodes, light.name, toGlm(from.mPosition), toGlm(from.mDirection), toGlm(from.mUp))
        .light = static_cast<int>(scene.lights.size());
    scene.lights.push_back(std::move(light));
  }
}

void readAssimpAnimations(const aiScene& source, const AssimpNodes& nodes, Scene& scene) {
  for (unsigned a = 0; a < source.mNumAnimations; ++a) {
    const aiAnimation& from = *source.mAnimations[a];
    const double seconds_per_tick = 1.0 / (from.mTicksPerSecond > 0.0 ? from.mTicksPerSecond : 25.0);
    Animation animation;
    animation.name = from.mName.C_Str();
    for (unsigned c = 0; c < from.mNumChannels; ++c) {
      const aiNodeAnim& keys = *from.mChannels[c];
      const auto found = nodes.by_name.find(keys.mNodeName.C_Str());
      if (found == nodes.by_name.end()) continue;
      Node& node = scene.nodes[static_cast<std::size_t>(found->second)];
      if (node.matrix) {
        const std::optional<Trs> trs = decomposeTrs(*node.matrix);
        if (!trs) continue;
        node.translation = trs->translation, node.rotation = trs->rotation, node.scale = trs->scale;
        node.matrix.reset();
      }
      const auto add = [&](AnimationChannel::Path path, int components, unsigned count, auto valueOf) {
        AnimationChannel channel;
        channel.node = found->second;
        channel.path = path;
        channel.components = components;
        for (unsigned k = 0; k < count; ++k) {
          const auto [time, value] = valueOf(k);
          const auto time_s = static_cast<float>(time * seconds_per_tick);
          bool good = std::isfinite(time_s) && (channel.times_s.empty() || time_s > channel.times_s.back());
          for (int i = 0; i < components; ++i) good = good && std::abs(value[i]) < 1e12f;
          if (!good) continue;
          channel.times_s.push_back(time_s);
          for (int i = 0; i < components; ++i) channel.values.push_back(value[i]);
        }
        if (!channel.times_s.empty()) animation.channels.push_back(std::move(channel));
      };
      const auto vectorKey = [](const aiVectorKey& key) {
        return std::pair(key.mTime, glm::vec4(toGlm(key.mValue), 0.0f));
      };
      using Path = AnimationChannel::Path;
      add(Path::kTranslation, 3, keys.mNumPositionKeys,
          [&](unsigned k) { return vectorKey(keys.mPositionKeys[k]); });
      add(Path::kScale, 3, keys.mNumScalingKeys, [&](unsigned k) { return vectorKey(keys.mScalingKeys[k]); });
      add(Path::kRotation, 4, keys.mNumRotationKeys, [&](unsigned k) {
        const aiQuaternion& q = keys.mRotationKeys[k].mValue;
        return std::pair(keys.mRotationKeys[k].mTime, glm::vec4(q.x, q.y, q.z, q.w));
      });
    }
    if (!animation.channels.empty()) scene.animations.push_back(std::move(animation));
  }
}

}  // namespace gloam

#endif
