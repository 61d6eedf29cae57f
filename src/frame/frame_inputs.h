// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The two sides of a technique: what a frame gives it (FrameInputs) and what it hands on (Lighting).
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "frame/emission.h"
#include "frame/environment_light.h"
#include "frame/gbuffer.h"
#include "frame/proxy.h"
#include "frame/receivers.h"
#include "frame/shadow_maps.h"

namespace gloam::frame {

/// All that a technique may read. Valid while the frame is recorded.
struct FrameInputs {
  const GpuScene& scene;
  const GBuffer& gbuffer;
  Receivers& receivers;  ///< asks for what it needs: receivers.at(4)
  const ShadowMaps& shadow_maps;
  const EnvironmentLight& environment;
  gpu::BufferRef view;                  ///< FrameView
  Warnings& warnings;                   ///< one-line remarks for whoever renders
  std::span<const Proxy> proxies = {};  ///< spheres in place of what moves; empty unless someone made them
  const Emission* emission = nullptr;   ///< what they send; null unless someone made it
  std::span<const Patch> flats = {};    ///< what has no proxies, as blockers of light; with proxies
  std::string_view show = {};           ///< an image to look at: pictures drawn for that alone are drawn then
  std::string_view scene_key = {};      ///< standing.h's, for images kept while the scene stands; empty: none are
};

/// First surface lit by a source, or by other surfaces.
enum class Path : std::uint8_t { kDirect, kIndirect };

/// RGB irradiance with the receiver's normal applied, its albedo not: k_d / pi times it leaves the surface.
struct Irradiance {
  gpu::ImageRef image;  ///< RGB, floats or halves, of the size of receivers.at(divisor)
  Path path = Path::kDirect;
  int divisor = 1;             ///< below full size it is upsampled along surfaces (PX-8)
  bool along_surfaces = true;  ///< false: plainly bilinear
};

/// RGB radiance that each pixel's Phong lobe gathers, of integral 1, at the pixel's exponent and about the mirror
/// direction of its shading normal: k_s times it leaves the surface.
struct Gloss {
  gpu::ImageRef image;  ///< RGB, floats or halves, at full size
  Path path = Path::kDirect;
};

/// What a volume sends toward the eye, voxel by voxel.
struct VolumeLight {
  gpu::ImageRef
      direct;  ///< 3D; RGB: radiance times albedo, of light scattered once; A: extinction, 1 / length of the node
  gpu::ImageRef indirect;  ///< 3D, of the same size; RGB: of light scattered more often
  glm::mat4 world_from_node{1.0f};
  glm::vec3 bounds_min{0.0f}, bounds_max{1.0f};  ///< of the box that the images fill, in the node
};

/// What a technique hands on, never final colour. Terms of different light paths add up.
struct Lighting {
  std::vector<Irradiance> irradiance;
  std::vector<Gloss> gloss;
  std::vector<VolumeLight> volumes;
  /// True: the technique's terms contain the direct light of lamps, else frame/ shades it with its shadow
  /// maps.
  bool has_local_direct = false;
  /// True: `gloss` contains that of the environment, else frame/ adds the unshadowed Phong
  /// lobe.
  bool has_environment_gloss = false;
};

/// A technique, as far as frame/ knows of it.
using LightingStep = std::function<Lighting(gpu::FrameGraph&, const FrameInputs&)>;

}  // namespace gloam::frame
