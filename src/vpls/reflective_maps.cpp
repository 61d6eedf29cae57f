// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Dachsbacher, Stamminger 2005, "Reflective shadow maps". Differs: the surface is found by the G-buffer's own shaders,
// so that sides, textures and holes are those of the picture; a texel's flux is the lamp's power through its solid
// angle, not through its middle.
#include "vpls/reflective_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frame/view.h"
#include "gpu/shader_reload.h"
#include "shaders/frame_shaders.h"
#include "shaders/vpls_shaders.h"
#include "vpls/vpls_shared.h"

namespace gloam::vpls {

namespace {

constexpr float kNearest_m = 1e-3f;       ///< of what a lamp lights; nearer still in small scenes
constexpr float kWidestSpotRad = 1.05f;   ///< to each side; wider ones get a cube
constexpr int kColumns = 6;               ///< of the atlas
constexpr std::size_t kViewStride = 256;  ///< where uniform blocks may begin on any device

/// World from view axes (right, up, back) that look along `forward` and change steadily with it, but where it points
/// straight up: Frisvad 2012, "Building an orthonormal basis from a 3D unit vector without normalization".
glm::mat4 steadyAxes(const glm::vec3& forward, const glm::vec3& eye) {
  const glm::vec3 n(forward.x, forward.z, -forward.y);
  glm::vec3 u(0, -1, 0), v(-1, 0, 0);
  if (n.z > -0.9999999f) {
    const float a = 1.0f / (1.0f + n.z), b = -n.x * n.y * a;
    u = glm::vec3(1.0f - n.x * n.x * a, b, -n.x);
    v = glm::vec3(b, 1.0f - n.y * n.y * a, -n.y);
  }
  const auto back_turned = [](const glm::vec3& p) { return glm::vec3(p.x, -p.z, p.y); };
  glm::mat4 axes(1.0f);
  axes[0] = glm::vec4(back_turned(v), 0.0f);
  axes[1] = glm::vec4(back_turned(u), 0.0f);
  axes[2] = glm::vec4(-forward, 0.0f);
  axes[3] = glm::vec4(eye, 1.0f);
  return axes;
}

frame::FrameView perspectiveView(const glm::vec3& eye, const glm::vec3& forward, float half_angle_rad,
                                 const glm::vec3& low, const glm::vec3& high, int size) {
  PosedCamera camera;
  camera.camera.vertical_fov_rad = 2.0f * half_angle_rad;
  camera.camera.z_near = std::min(1e-4f * std::max(glm::length(high - low), 1e-3f), kNearest_m);
  camera.world_from_view = steadyAxes(forward, eye);
  return frame::makeView(camera, size, size, low, high);
}

/// Half sides in quarter octaves, the middle by a sixteenth of them: virtual lights stand still while things move.
frame::FrameView directionalView(const glm::vec3& direction, const glm::vec3& low, const glm::vec3& high,
                                 int size) {
  const glm::mat4 axes = steadyAxes(direction, glm::vec3(0.0f));
  glm::vec3 least(std::numeric_limits<float>::max()), greatest(-std::numeric_limits<float>::max());
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
    const glm::vec3 q = glm::transpose(glm::mat3(axes)) * p;
    least = glm::min(least, q);
    greatest = glm::max(greatest, q);
  }
  const float raw = 0.5f * std::max({greatest.x - least.x, greatest.y - least.y, 1e-4f});
  PosedCamera camera;
  camera.camera.perspective = false;
  camera.camera.half_height = std::exp2(std::ceil(4.0f * std::log2(raw * (1.0f + 1.0f / 16.0f))) / 4.0f);
  const float step = camera.camera.half_height / 16.0f;
  const glm::vec3 middle = 0.5f * (least + greatest);
  const float slack = 1e-3f * (greatest.z - least.z) + 1e-3f * raw;
  camera.camera.z_near = slack;
  const glm::vec3 eye(std::round(middle.x / step) * step, std::round(middle.y / step) * step,
                      greatest.z + 2.0f * slack);
  camera.world_from_view = steadyAxes(direction, glm::mat3(axes) * eye);
  return frame::makeView(camera, size, size, low, high);
}

std::vector<frame::FrameView> viewsOf(const frame::LightRow& light, const glm::vec3& low,
                                      const glm::vec3& high, int size) {
  if (light.kind == frame::kLightDirectional) return {directionalView(light.direction, low, high, size)};
  const float outer = std::acos(std::clamp(light.cos_outer, -1.0f, 1.0f));
  if (light.kind == frame::kLightSpot && outer < kWidestSpotRad)
    return {perspectiveView(light.position, light.direction, std::max(outer, 1e-3f), low, high, size)};
  std::vector<frame::FrameView> faces;  // +X -X +Y -Y +Z -Z
  for (int face = 0; face < 6; ++face) {
    glm::vec3 forward(0.0f);
    forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
    faces.push_back(perspectiveView(light.position, forward, 0.25f * 3.14159265f, low, high, size));
  }
  return faces;
}

struct Targets {
  gpu::ImageRef depth, ids, normals, diffuse, specular, emission;
};

void drawMap(gpu::FrameGraph& graph, const frame::GpuScene& scene, const Targets& targets,
             const ReflectiveMap& map, int size, gpu::BufferRef view) {
  const std::array<std::uint32_t, 4> nothing = {0, 0, 0, 0};
  const std::array<float, 4> black = {0.0f, 0.0f, 0.0f, 0.0f};
  auto& pass = graph.raster("vpls.maps", frame_gbuffer_vert_spv, frame_gbuffer_frag_spv)
                   .state({.depth_compare = VK_COMPARE_OP_GREATER})
                   .viewport(map.x, map.y, size, size)
                   .depth(targets.depth, 0.0f)
                   .color("ids", targets.ids, nothing)
                   .color("normals", targets.normals, nothing)
                   .color("diffuse", targets.diffuse, black)
                   .color("specular", targets.specular, black)
                   .color("emission", targets.emission, black)
                   .read("frame_view", view);
  scene.bindSurface(scene.bindPlaces(pass));
  for (const frame::DrawRange& range : scene.draws()) {
    if (!frame::isOutside(range, map.view.clip_from_world))
      frame::drawSurface(pass, scene, range.mesh, range.first_place, range.count);
  }
}

/// Of all that the maps show; empty where someone looks at the pictures that they are made from.
std::string keyOf(const frame::FrameInputs& inputs, const std::vector<ReflectiveMap>& maps) {
  if (inputs.scene_key.empty() || inputs.show.starts_with("vpls.")) return {};
  std::string key(inputs.scene_key);
  const auto append = [&key](const auto& value) {
    key.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const gpu::ShaderCode* shader : {&frame_gbuffer_vert_spv, &frame_gbuffer_frag_spv, &vpls_reflect_spv})
    append(&gpu::currentShader(*shader));  // shaders may be edited while a program runs
  for (const ReflectiveMap& map : maps) {
    append(map.view);
    append(inputs.shadow_maps.lights[map.light]);
  }
  return key;
}

}  // namespace

std::vector<ReflectiveMap> planReflectiveMaps(std::span<const frame::LightRow> lights,
                                              const glm::vec3& bounds_min, const glm::vec3& bounds_max,
                                              int size, std::size_t most, Warnings& warnings) {
  std::vector<ReflectiveMap> maps;
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto views = viewsOf(lights[i], bounds_min, bounds_max, size);
    if (maps.size() + views.size() > most) {
      ++left_out;
      continue;
    }
    for (const frame::FrameView& view : views) {
      const int at = int(maps.size());
      maps.push_back({i, view, at % kColumns * size, at / kColumns * size});
    }
  }
  if (left_out > 0)
    warnings.push_back(fmt::format(
        "{} lamps send no indirect light: there is room for {} reflective maps of {} texels a side", left_out,
        most, size));
  return maps;
}

ReflectiveMaps recordReflectiveMaps(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, int size) {
  const frame::ShadowMaps& lamps = inputs.shadow_maps;
  ReflectiveMaps result;
  result.size = size;
  if (lamps.lights.empty()) return result;
  const std::size_t rows = std::max<std::size_t>(
      1, std::min<std::size_t>(graph.device().limits().max_image_size / std::size_t(size),
                               (std::size_t(4) << 20) / (std::size_t(size) * std::size_t(size))));
  result.maps = planReflectiveMaps(lamps.lights, inputs.scene.boundsMin(), inputs.scene.boundsMax(), size,
                                   kColumns * rows, inputs.warnings);
  if (result.maps.empty()) return result;
  const int count = int(result.maps.size());
  const int width = std::min(count, kColumns) * size, height = (count + kColumns - 1) / kColumns * size;
  const auto descOf = [&](VkFormat format) {
    return gpu::ImageDesc{.format = format, .width = width, .height = height};
  };
  // Where neither the lamps nor the scene have changed, what they reflect has not.
  const std::string key = keyOf(inputs, result.maps);
  bool stands = true;
  const auto keep = [&](const char* name, VkFormat format) {
    const gpu::KeptImage kept = graph.keep(name, descOf(format), key);
    stands &= kept.holds;
    return kept.image;
  };
  result.position = keep("vpls.position", VK_FORMAT_R32G32B32A32_SFLOAT);
  result.normal = keep("vpls.normal", VK_FORMAT_R16G16B16A16_SFLOAT);
  result.flux = keep("vpls.flux", VK_FORMAT_R32G32B32A32_SFLOAT);
  if (stands) return result;

  const auto image = [&](const char* name, VkFormat format) { return graph.create(name, descOf(format)); };
  const Targets targets{image("vpls.depth", VK_FORMAT_D32_SFLOAT),
                        image("vpls.ids", VK_FORMAT_R32G32_UINT),
                        image("vpls.normals_packed", VK_FORMAT_R32G32_UINT),
                        image("vpls.diffuse", VK_FORMAT_R16G16B16A16_SFLOAT),
                        image("vpls.specular", VK_FORMAT_R16G16B16A16_SFLOAT),
                        image("vpls.emission", VK_FORMAT_R16G16B16A16_SFLOAT)};

  std::vector<std::byte> views(result.maps.size() * kViewStride);
  for (std::size_t i = 0; i < result.maps.size(); ++i)
    std::memcpy(views.data() + i * kViewStride, &result.maps[i].view, sizeof(frame::FrameView));
  const gpu::BufferRef view_rows = graph.upload("vpls.views", views);
  for (std::size_t i = 0; i < result.maps.size(); ++i) {
    const ReflectiveMap& map = result.maps[i];
    const gpu::BufferRef view = view_rows.slice(i * kViewStride, sizeof(frame::FrameView));
    drawMap(graph, inputs.scene, targets, map, size, view);
    graph.compute("vpls.reflect", vpls_reflect_spv)
        .read("frame_view", view)
        .read("light", lamps.lightRow(map.light))
        .read("depth", targets.depth)
        .read("normals", targets.normals)
        .read("diffuse", targets.diffuse)
        .read("specular", targets.specular)
        .write("position_map", result.position)
        .write("normal_map", result.normal)
        .write("flux_map", result.flux)
        .push(MapPlace{{map.x, map.y}, size, 0, 0, 0})
        .dispatchOver(size, size);
  }
  return result;
}

}  // namespace gloam::vpls
