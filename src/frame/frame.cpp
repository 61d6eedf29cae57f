// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The page: every pass of a frame in the order in which it runs.
#include "frame/frame.h"

#include "frame/standing.h"
#include "frame/view.h"
#include "frame/volumes.h"

namespace gloam::frame {

namespace {

constexpr std::size_t kShadowBudgetBytes = std::size_t(512) << 20;
constexpr int kMaxShadowMaps = 256;  ///< layers that every Vulkan device gives an image

FrameView viewOfFrame(const PosedCamera& camera, const GpuScene& scene, const FrameOptions& options,
                      FrameMemory& memory) {
  FrameView view = makeView(camera, options.width * options.supersample, options.height * options.supersample,
                            scene.boundsMin(), scene.boundsMax());
  if (memory.view) view.previous_clip_from_world = memory.view->clip_from_world;
  memory.view = view;
  return view;
}

}  // namespace

FrameImages recordFrame(gpu::FrameGraph& graph, GpuScene& scene, const EnvironmentLight& environment,
                        const PosedScene& posed, const PosedCamera& camera, const FrameOptions& options,
                        const LightingStep& technique, FrameMemory& memory, Warnings& warnings) {
  // Where everything is.
  scene.pose(graph, posed);
  const FrameView view = viewOfFrame(camera, scene, options, memory);
  const gpu::BufferRef view_buffer = graph.uploadOne("frame.view", view);

  const LightPlan plan = planLights(posed.lights, view, scene.boundsMin(), scene.boundsMax(),
                                    options.shadow_map_size, kShadowBudgetBytes, kMaxShadowMaps, warnings);

  // What of the frames before still stands.
  const std::string scene_key = sceneKey(scene, posed), gbuffer_key = gbufferKey(scene_key, view),
                    shadow_key = shadowKey(scene_key, plan);
  graph.setKeeps(!options.repeats || gbuffer_key != memory.gbuffer_key || shadow_key != memory.shadow_key);
  memory.gbuffer_key = gbuffer_key, memory.shadow_key = shadow_key;

  // What the camera sees.
  const GBuffer gbuffer = recordGBuffer(graph, scene, view_buffer, options.width, options.height,
                                        options.supersample, gbuffer_key);
  if (options.motion) recordMotion(graph, scene, gbuffer, view_buffer);

  // What the lamps see.
  const ShadowMaps shadow_maps = recordShadowMaps(graph, scene, plan, shadow_key);

  // The technique: receivers as it asks for them, then irradiance and fields.
  Receivers receivers(graph, gbuffer, view_buffer);
  const FrameInputs inputs{scene,       gbuffer,  receivers,       shadow_maps,      environment,
                           view_buffer, warnings, options.proxies, options.emission, options.flats,
                           options.show, scene_key};
  const Lighting lighting = technique(graph, inputs);

  // Light becomes colour, samples become pixels.
  const gpu::ImageRef local_light =
      lighting.has_local_direct ? gpu::ImageRef() : recordLocalLight(graph, inputs);
  const Shaded shaded = recordShade(graph, inputs, lighting, local_light, options.background);
  recordVolumes(graph, inputs, lighting, view.eye, shaded);
  return recordResolve(graph, inputs, shaded, options.layers);
}

std::size_t estimateBytes(const FrameOptions& options) {
  const std::size_t pixels = std::size_t(options.width) * std::size_t(options.height);
  const std::size_t samples = pixels * std::size_t(options.supersample) * std::size_t(options.supersample);
  // Samples: G-buffer, lamps, two irradiance images, direct and indirect. Pixels: colour, direct, indirect,
  // layers.
  return samples * (kGBufferBytes + 5 * 8) + pixels * (3 * 8 + (options.layers ? 8 + 4 + 8 + 4 : 0));
}

}  // namespace gloam::frame
