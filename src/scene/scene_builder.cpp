// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/scene_builder.h"

#include <cmath>

namespace gloam {

int SceneBuilder::diffuse(const std::string& name, const glm::vec3& albedo) {
  Material m;
  m.name = name;
  m.base_color = glm::vec4(albedo, 1.0f);
  m.metallic = 0.0f;
  m.specular = 0.0f;
  scene_.materials.push_back(std::move(m));
  return int(scene_.materials.size()) - 1;
}

int SceneBuilder::glossy(const std::string& name, const glm::vec3& albedo, float roughness) {
  const int index = diffuse(name, albedo);
  material(index).specular = 1.0f;
  material(index).roughness = roughness;
  return index;
}

int SceneBuilder::metal(const std::string& name, const glm::vec3& color, float roughness) {
  const int index = glossy(name, color, roughness);
  material(index).metallic = 1.0f;
  return index;
}

int SceneBuilder::texture(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return int(scene_.textures.size()) - 1;
}

int SceneBuilder::mesh(const std::string& name, Mesh mesh, int material) {
  mesh.name = name;
  mesh.material = material;
  scene_.meshes.push_back(std::move(mesh));
  return int(scene_.meshes.size()) - 1;
}

int SceneBuilder::node(const std::string& name, int parent, const glm::vec3& translation) {
  const int index = int(scene_.nodes.size());
  Node node;
  node.name = name;
  node.parent = parent;
  node.translation = translation;
  scene_.nodes.push_back(std::move(node));
  if (parent == kNone) {
    scene_.roots.push_back(index);
  } else {
    at(parent).children.push_back(index);
  }
  return index;
}

int SceneBuilder::place(const std::string& name, Mesh mesh_data, int material, const glm::vec3& translation,
                        int parent) {
  const int mesh_index = mesh(name, std::move(mesh_data), material);
  const int index = node(name, parent, translation);
  at(index).meshes = {mesh_index};
  return index;
}

void SceneBuilder::camera(const glm::vec3& eye, const glm::vec3& target, float vertical_fov_deg) {
  Camera camera;
  camera.name = "camera";
  camera.vertical_fov_rad = glm::radians(vertical_fov_deg);
  camera.z_near = 0.02f * glm::length(target - eye);
  scene_.cameras.push_back(camera);
  const int index = node("camera", kNone, eye);
  at(index).rotation = lookingAlong(target - eye);
  at(index).camera = int(scene_.cameras.size()) - 1;
}

int SceneBuilder::light(const Light& light, const glm::vec3& position, const glm::vec3& direction,
                        int parent) {
  scene_.lights.push_back(light);
  const int index = node(light.name, parent, position);
  if (light.type != Light::Type::kPoint) at(index).rotation = lookingAlong(direction);
  at(index).light = int(scene_.lights.size()) - 1;
  return index;
}

void SceneBuilder::sky(const std::string& description) {
  scene_.environment = loadEnvironment("sky:" + description);
}

AnimationChannel& SceneBuilder::channel(int node, AnimationChannel::Path path,
                                        AnimationChannel::Interpolation interpolation) {
  if (scene_.animations.empty()) scene_.animations.push_back({"animation", {}});
  AnimationChannel c;
  c.node = node;
  c.path = path;
  c.interpolation = interpolation;
  c.components = path == AnimationChannel::Path::kRotation ? 4 : 3;
  scene_.animations[0].channels.push_back(std::move(c));
  return scene_.animations[0].channels.back();
}

int SceneBuilder::skin(std::vector<int> joints, std::vector<glm::mat4> joint_from_mesh) {
  scene_.skins.push_back({std::move(joints), std::move(joint_from_mesh)});
  return int(scene_.skins.size()) - 1;
}

Scene SceneBuilder::finish() {
  return std::move(scene_);
}

glm::quat lookingAlong(const glm::vec3& direction) {
  const glm::vec3 back = -glm::normalize(direction);
  const glm::vec3 up = std::abs(back.y) < 0.999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

void addKey(AnimationChannel& channel, float time_s, const glm::vec3& value) {
  channel.times_s.push_back(time_s);
  channel.values.insert(channel.values.end(), {value.x, value.y, value.z});
}

void addKey(AnimationChannel& channel, float time_s, const glm::quat& value) {
  channel.times_s.push_back(time_s);
  channel.values.insert(channel.values.end(), {value.x, value.y, value.z, value.w});
}

}  // namespace gloam
