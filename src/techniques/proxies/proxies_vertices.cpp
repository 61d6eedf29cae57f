// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan et al. 2007, figure 6, with one kernel for both sides: vertices are put into a picture, 64 that follow each other to a
// tile, which then is a level of receivers as any other.
#include "techniques/proxies/proxies_vertices.h"

#include <glm/gtc/matrix_inverse.hpp>

#include "frame/environment_light.h"
#include "techniques/proxies/proxies.h"

namespace gloam::proxies {

namespace {

constexpr int kColumns = 256;

struct Points {
  std::vector<glm::vec4> positions, normals;  // a texel each; w 0 where there is none
  int height = 0;
  std::size_t count = 0;
};

/// Texel of the i-th vertex: tile after tile.
std::size_t texelOf(std::size_t i) {
  const std::size_t side = kTileSize, tile = i / (side * side), within = i % (side * side);
  const std::size_t tiles_across = kColumns / side;
  const std::size_t x = tile % tiles_across * side + within % side,
                    y = tile / tiles_across * side + within / side;
  return y * kColumns + x;
}

Points pointsOf(const Scene& scene, const PosedScene& posed) {
  std::vector<glm::vec3> positions, normals;
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const auto& from = instance.deformed() ? instance.deformed_positions : mesh.positions;
    const auto& turned = instance.deformed() ? instance.deformed_normals : mesh.normals;
    const glm::mat3 world_from_normal = glm::inverseTranspose(glm::mat3(instance.world_from_object));
    for (std::size_t v = 0; v < from.size(); ++v) {
      positions.emplace_back(instance.world_from_object * glm::vec4(from[v], 1.0f));
      const glm::vec3 n = v < turned.size() ? world_from_normal * turned[v] : glm::vec3(0, 1, 0);
      normals.push_back(glm::dot(n, n) > 0.0f ? glm::normalize(n) : glm::vec3(0, 1, 0));
    }
  }
  if (positions.empty()) throw Error("vertices", "the scene has none");
  Points points;
  points.count = positions.size();
  const std::size_t row = std::size_t(kColumns) * kTileSize;  // of tiles
  const std::size_t rows = (points.count + row - 1) / row;
  points.height = int(rows * kTileSize);
  points.positions.assign(rows * row, glm::vec4(0.0f));
  points.normals.assign(rows * row, glm::vec4(0.0f));
  for (std::size_t i = 0; i < points.count; ++i) {
    points.positions[texelOf(i)] = glm::vec4(positions[i], 1.0f);
    points.normals[texelOf(i)] = glm::vec4(normals[i], 1.0f);
  }
  return points;
}

gpu::Image imageOf(gpu::Device& device, const char* name, const std::vector<glm::vec4>& texels, int height) {
  gpu::Image image(device, name,
                   {.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = kColumns, .height = height});
  image.upload(texels);
  return image;
}

}  // namespace

struct VertexShading::State {
  std::unique_ptr<gpu::Device> device;
  gpu::FrameGraph graph;
  frame::GpuScene scene;
  frame::EnvironmentLight environment;
  Proxies technique;
  std::vector<frame::Proxy> proxies;
  std::size_t count = 0;
  int height = 0;
  gpu::Image positions, normals;

  State(std::unique_ptr<gpu::Device> d, const Scene& s, const Environment& light)
      : device(std::move(d)),
        graph(*device),
        scene(*device, s),
        environment(*device, light),
        technique(*device) {
    graph.setTimed(true);
  }
};

VertexShading::VertexShading(const std::string& device, const Scene& scene, const PosedScene& posed,
                             const Environment& environment, std::span<const frame::Proxy> proxies)
    : state_(std::make_unique<State>(gpu::Device::create({.choice = device}), scene, environment)) {
  const Points points = pointsOf(scene, posed);
  state_->proxies.assign(proxies.begin(), proxies.end());
  state_->count = points.count;
  state_->height = points.height;
  state_->positions = imageOf(*state_->device, "vertices.positions", points.positions, points.height);
  state_->normals = imageOf(*state_->device, "vertices.normals", points.normals, points.height);
}
VertexShading::~VertexShading() = default;

std::size_t VertexShading::vertexCount() const {
  return state_->count;
}

std::vector<PassTime> VertexShading::shade(const Settings& settings) {
  Settings own = settings;
  own.set("divisor", "1");
  gpu::FrameGraph& graph = state_->graph;
  graph.begin();
  const frame::GBuffer gbuffer{.width = kColumns, .height = state_->height};
  const gpu::BufferRef view = graph.uploadOne("frame.view", frame::FrameView{});
  frame::Receivers receivers(graph, gbuffer, view);
  receivers.set({.divisor = 1,
                 .width = kColumns,
                 .height = state_->height,
                 .position = graph.import("frame.receiver_position_1", state_->positions),
                 .normal_depth = graph.import("frame.receiver_normal_1", state_->normals)});
  const frame::ShadowMaps no_lamps;
  Warnings warnings;
  const frame::FrameInputs inputs{state_->scene,       gbuffer, receivers, no_lamps,
                                  state_->environment, view,    warnings,  state_->proxies};
  state_->technique.record(graph, inputs, own);
  graph.execute();
  std::vector<PassTime> times;
  for (const gpu::PassTime& time : graph.times()) times.push_back({time.name, time.milliseconds});
  return times;
}

std::vector<glm::vec3> VertexShading::direct() const {
  const std::vector<float> texels = state_->graph.find("proxies.direct").image().downloadFloats();
  std::vector<glm::vec3> result;
  for (std::size_t i = 0; i < state_->count; ++i) {
    const float* texel = &texels[4 * texelOf(i)];
    result.emplace_back(texel[0], texel[1], texel[2]);
  }
  return result;
}

}  // namespace gloam::proxies
