// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/punctual.h"
#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

/// A face of a cube as a camera: columns along u, rows along v of sh::cubeDirection, reversed depth without a far plane.
FrameView faceView(const ProbePlace& place, int face, int size) {
  FrameView view{};
  const float root = std::sqrt(2.0f);
  const glm::vec3 forward = sh::cubeDirection(face, 0.5f, 0.5f);
  const glm::vec3 right = root * sh::cubeDirection(face, 1.0f, 0.5f) - forward;
  const glm::vec3 down = root * sh::cubeDirection(face, 0.5f, 1.0f) - forward;
  view.eye = place.position;
  view.z_near = place.z_near;
  view.forward = forward;
  view.width = view.height = static_cast<std::uint32_t>(size);
  view.corner = forward - right - down;
  view.step_x = 2.0f / float(size) * right;
  view.step_y = 2.0f / float(size) * down;
  glm::mat4 clip_from_axes(0.0f);
  clip_from_axes[0][0] = clip_from_axes[1][1] = 1.0f;
  clip_from_axes[2][3] = 1.0f;
  clip_from_axes[3][2] = place.z_near;
  const glm::mat3 axes_from_world = glm::transpose(glm::mat3(right, down, forward));
  glm::mat4 from_world(axes_from_world);
  from_world[3] = glm::vec4(-(axes_from_world * place.position), 1.0f);
  view.clip_from_world = clip_from_axes * from_world;
  view.previous_clip_from_world = view.clip_from_world;
  return view;
}

ProbeLamp lampAt(const LightRow& lamp, const glm::vec3& position) {
  ProbeLamp row{};
  row.direction = -lamp.direction;
  row.irradiance = lamp.intensity;
  if (lamp.kind != kLightDirectional) {
    const glm::vec3 between = lamp.position - position;
    const float squared = std::max(glm::dot(between, between), punctual::kLeastSquaredDistance);
    row.distance = std::sqrt(squared);
    row.direction = glm::length(between) > 0.0f ? glm::normalize(between) : glm::vec3(0.0f, 1.0f, 0.0f);
    row.irradiance *= punctual::rangeFactor(row.distance, lamp.range) / squared;
    if (lamp.kind == kLightSpot)
      row.irradiance *=
          punctual::coneFactor(-glm::dot(row.direction, lamp.direction), lamp.cos_inner, lamp.cos_outer);
  }
  const sh::Sh y = sh::directionalLight(sh::kMaxOrder, glm::normalize(row.direction));
  std::copy_n(y.c.begin(), sh::kMaxCoefficients, row.basis);
  return row;
}

/// Rows of a rotation of six bands: row i holds the 2 l + 1 columns of its band.
void appendTurn(const glm::mat3& matrix, std::vector<float>& turns) {
  const sh::Rotation rotation = sh::makeRotation(sh::kMaxOrder, matrix);
  const std::size_t first = turns.size();
  turns.resize(first + std::size_t(sh::kMaxCoefficients) * 11, 0.0f);
  for (int l = 0; l < sh::kMaxOrder; ++l) {
    for (int k = 0; k < 2 * l + 1; ++k) {
      sh::Sh unit(sh::kMaxOrder);
      unit[l * l + k] = 1.0f;
      const sh::Sh column = sh::rotate(rotation, unit);
      for (int row = l * l; row < (l + 1) * (l + 1); ++row)
        turns[first + std::size_t(row) * 11 + std::size_t(k)] = column[row];
    }
  }
}

}  // namespace

std::size_t Probes::most(const gpu::Device& device, int size) {
  return device.limits().max_image_size / std::size_t(size);
}

Probes::Probes(gpu::FrameGraph& graph, const FrameInputs& inputs, ProbeTables& tables,
               const std::string& name, std::vector<ProbePlace> places, std::span<const std::uint32_t> groups,
               const ProbeOptions& options)
    : graph_(graph),
      inputs_(inputs),
      tables_(tables),
      name_(name),
      places_(std::move(places)),
      options_(options) {
  if (places_.empty() || places_.size() > most(graph.device(), options.size))
    throw Error(name, fmt::format("{} probes of {} texels a side; 1 to {} fit into an image of this device",
                                  places_.size(), options.size, most(graph.device(), options.size)));
  const int width = 6 * options.size, height = int(places_.size()) * options.size;
  const auto image = [&](const char* suffix, VkFormat format) {
    return graph.create(name + suffix, gpu::ImageDesc{.format = format, .width = width, .height = height});
  };
  depth_ = image("_depth", VK_FORMAT_D32_SFLOAT);
  ids_ = image("_ids", VK_FORMAT_R32G32_UINT);
  normals_ = image("_normals_packed", VK_FORMAT_R32G32_UINT);
  diffuse_ = image("_diffuse", VK_FORMAT_R16G16B16A16_SFLOAT);
  specular_ = image("_specular", VK_FORMAT_R16G16B16A16_SFLOAT);
  emission_ = image("_emission", VK_FORMAT_R16G16B16A16_SFLOAT);
  emitted_ = image("_emitted", VK_FORMAT_R16G16B16A16_SFLOAT);
  reflected_ = image("_reflected", VK_FORMAT_R16G16B16A16_SFLOAT);

  std::vector<ProbeView> views;
  for (const ProbePlace& place : places_) {
    for (int face = 0; face < 6; ++face) views.push_back({faceView(place, face, options.size), {}});
  }
  views_ = graph.upload(name + "_views", views);
  for (std::size_t p = 0; p < places_.size(); ++p) {
    for (int face = 0; face < 6; ++face) drawFace(p, face, views[6 * p + std::size_t(face)].view, groups);
  }
  lamps_ = graph.upload(name + "_lamps", lampRows());
  sums_ = graph.create(name + "_sums",
                       gpu::BufferDesc{.bytes = places_.size() * 6 * kProbeStride * sizeof(ProbeSums)});
  lamps_seen_ = graph.create(
      name + "_lamps_seen",
      gpu::BufferDesc{.bytes = std::max<std::size_t>(places_.size() * inputs_.shadow_maps.lights.size(), 1) *
                               sizeof(float)});
  trust_ = graph.create(name + "_trust", gpu::BufferDesc{.bytes = places_.size() * sizeof(float)});
}

void Probes::drawFace(std::size_t probe, int face, const FrameView& view,
                      std::span<const std::uint32_t> groups) {
  const GpuScene& scene = inputs_.scene;
  const std::array<std::uint32_t, 4> nothing = {0, 0, 0, 0};
  const std::array<float, 4> black = {0.0f, 0.0f, 0.0f, 0.0f};
  const std::size_t row = 6 * probe + std::size_t(face);
  auto& pass = graph_.raster(name_, frame_gbuffer_vert_spv, frame_gbuffer_frag_spv)
                   .state({.depth_compare = VK_COMPARE_OP_GREATER})
                   .viewport(face * options_.size, int(probe) * options_.size, options_.size, options_.size)
                   .depth(depth_, 0.0f)
                   .color("ids", ids_, nothing)
                   .color("normals", normals_, nothing)
                   .color("diffuse", diffuse_, black)
                   .color("specular", specular_, black)
                   .color("emission", emission_, black)
                   .read("frame_view", views_.slice(row * sizeof(ProbeView), sizeof(FrameView)));
  scene.bindSurface(scene.bindPlaces(pass));
  for (const DrawRange& range : scene.draws()) {
    if (isOutside(range, view.clip_from_world)) continue;
    const std::uint32_t end = range.first_place + range.count;
    for (std::uint32_t first = range.first_place; first < end;) {
      std::uint32_t last = first;
      while (last < end && groups[scene.instanceAt(last)] != places_[probe].group) ++last;
      if (last > first) drawSurface(pass, scene, range.mesh, first, last - first);
      first = last + 1;
    }
  }
}

std::vector<ProbeLamp> Probes::lampRows() const {
  std::vector<ProbeLamp> rows;
  for (const ProbePlace& place : places_) {
    for (const LightRow& lamp : inputs_.shadow_maps.lights) rows.push_back(lampAt(lamp, place.position));
  }
  return rows;
}

void Probes::setReceivers(std::span<const ProbeReceiver> receivers) {
  std::vector<ProbeJob> jobs;
  std::vector<glm::mat3> matrices;
  std::vector<float> turns;
  for (const ProbeReceiver& receiver : receivers) {
    const auto known = std::ranges::find(matrices, receiver.axes_from_world);
    jobs.push_back({receiver.probe, static_cast<std::uint32_t>(known - matrices.begin())});
    if (known != matrices.end()) continue;
    matrices.push_back(receiver.axes_from_world);
    appendTurn(receiver.axes_from_world, turns);
  }
  receiver_count_ = static_cast<std::uint32_t>(jobs.size());
  jobs_ = graph_.upload(name_ + "_jobs", jobs);
  turns_ = graph_.upload(name_ + "_turns", turns);
  const std::size_t coefficients = std::size_t(options_.order) * std::size_t(options_.order);
  lights_ = graph_.create(name_ + "_lights",
                          gpu::BufferDesc{.bytes = jobs.size() * coefficients * sizeof(ProbeLight)});
  lamp_lights_ = graph_.create(name_ + "_lamp_lights",
                               gpu::BufferDesc{.bytes = jobs.size() * coefficients * sizeof(glm::vec3)});
}

void Probes::gather(const LitSurfaces& lit, bool lamps_on_lit, const sh::ShRgb& unlit) {
  const ShadowMaps& shadows = inputs_.shadow_maps;
  const auto size = static_cast<std::uint32_t>(options_.size);
  const auto lamp_count = static_cast<std::uint32_t>(shadows.lights.size());
  const ProbeTables::Sky& sky = tables_.sky(inputs_.environment, options_.size);
  std::array<glm::vec3, sh::kMaxCoefficients> unlit_rows{};
  for (int i = 0; i < unlit.size(); ++i) unlit_rows[std::size_t(i)] = unlit[i];
  gpu::BufferRef unlit_buffer = graph_.findBuffer(name_ + "_unlit");
  if (!unlit_buffer) unlit_buffer = graph_.uploadOne(name_ + "_unlit", unlit_rows);

  auto& light = graph_.compute(name_ + "_light", frame_probe_light_spv)
                    .read("probe_views", views_)
                    .read("depth", depth_)
                    .read("ids", ids_)
                    .read("normals", normals_)
                    .read("diffuse", diffuse_)
                    .read("specular", specular_)
                    .read("emission", emission_)
                    .read("lamps", shadows.light_rows)
                    .read("shadow_views", shadows.view_rows)
                    .sample("shadow_maps", shadows.maps, gpu::kNearestClamp)
                    .read("lit_rows", lit.rows)
                    .read("lightmap_uvs", inputs_.scene.uvs())
                    .read("surface_light", lit.vertex)
                    .read("unlit", unlit_buffer)
                    .read("sky", sky.texels)
                    .read("vertex_normals", inputs_.scene.normals())
                    .write("emitted", emitted_)
                    .write("reflected", reflected_)
                    .push(ProbeLightParams{size, lamp_count, lamps_on_lit ? 1u : 0u});
  inputs_.scene.bindTriangles(light).dispatchOver(emitted_);

  graph_.compute(name_ + "_project", frame_probe_project_spv)
      .read("table", tables_.projection(options_.size))
      .read("emitted", emitted_)
      .read("reflected", reflected_)
      .write("sums", sums_)
      .push(size)
      .dispatch(static_cast<std::uint32_t>(places_.size()), 6);

  ProbeGatherParams params{size, lamp_count, static_cast<std::uint32_t>(options_.order * options_.order), {}};
  std::copy(options_.band_factors.begin(), options_.band_factors.end(), params.band);
  graph_.compute(name_ + "_gather", frame_probe_gather_spv)
      .read("jobs", jobs_)
      .read("sums", sums_)
      .read("turns", turns_)
      .read("sky", sky.row)
      .read("lamps", lamps_)
      .read("probe_views", views_)
      .read("depth", depth_)
      .write("lights", lights_)
      .write("lamp_lights", lamp_lights_)
      .write("lamps_seen", lamps_seen_)
      .write("trust", trust_)
      .push(params)
      .dispatch(receiver_count_);
}

}  // namespace gloam::frame
