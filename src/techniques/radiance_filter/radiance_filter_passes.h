// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The passes of a frame: light of each pixel's set, averaged over pixels, shaded.
#pragma once

#include <fmt/format.h>

#include "techniques/radiance_filter/radiance_filter.h"
#include "techniques/radiance_filter/radiance_filter_shared.h"

namespace gloam::radiance_filter {

enum class Mode : std::uint8_t {
  kRadiance,           ///< RF-3 to RF-5
  kIrradiance,         ///< classical: shaded light is averaged, also across normals (RF-6)
  kIrradianceNormals,  ///< the same, not across normals
  kBrute,              ///< all sets at every pixel, shaded as kRadiance; no filter
  kBruteExact          ///< all sets at every pixel through the lobes themselves
};
enum class Filter : std::uint8_t { kTwoPass, kOnePass, kNone };

/// What a frame does, options taken with the picture's size.
struct Plan {
  Mode mode = Mode::kRadiance;
  Filter filter = Filter::kTwoPass;
  int width = 0, height = 0;
  glm::ivec2 sets{1}, taps{1};  ///< across, down
  float depth_threshold = 1.0f, normal_threshold = 1.0f, bound = 1.0f;
  bool lamps_in_field = false, views = false, beams = false, slopes = false;
  visibility::Means means = visibility::Means::kAuto;
  vpls::WalkOptions walks;
  std::vector<frame::Path> parts;  ///< one, or direct and indirect

  bool brute() const { return mode == Mode::kBrute || mode == Mode::kBruteExact; }
  /// True: three bands of radiance; false: what lobes make of it.
  bool keepsField() const { return mode == Mode::kRadiance || mode == Mode::kBrute; }
  int layers() const { return keepsField() ? kFieldLayers : kLobeLayers; }  ///< of a part
  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};
/// Makes smaller, with a remark, what the picture has no room for.
Plan planOf(const Settings& settings, int width, int height, Warnings& warnings);

/// An image of what pixels keep: all layers of all parts.
gpu::ImageRef createValues(gpu::FrameGraph& graph, const Plan& plan, const std::string& name,
                           VkFormat format);

/// True: the host does the two passes of RF-4, and of a field RF-5.
bool filtersOnHost(const gpu::Device& device, const Plan& plan);

struct Light {
  gpu::ImageRef values;     ///< layers of all parts (radiance_filter_shared.h), times the exposure
  gpu::BufferRef exposure;  ///< one float
  // For the host, where `values` is there for views alone.
  gpu::BufferRef points;       ///< SightPoint, by sets
  gpu::BufferRef host_values;  ///< halves, layers one after another
};

/// RF-2, RF-3: "radiance_filter.points", ".visibility", ".exposure", ".gather"; in a brute mode once a set.
Light recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                   const vpls::Walks& walks, visibility::Visibility& visibility);

/// What lobes make of one part of the light: images of halves, of the picture's size.
struct Shaded {
  gpu::ImageRef irradiance, gloss;
};
Shaded createShaded(gpu::FrameGraph& graph, const Plan& plan, std::size_t part);

struct HostResult {
  gpu::ImageRef filtered;      ///< where views want it, or what is filtered is light through lobes
  std::vector<Shaded> shaded;  ///< of each part; none where `filtered` is yet to be shaded
};
/// "radiance_filter.filter". `surfaces` is kept from frame to frame.
HostResult recordOnHost(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                        const Light& light, HostSurfaces& surfaces);
/// Which point is which pixel (RF-2); `only_set` or kEverySet.
Interleaving interleavingOf(const Plan& plan, const frame::GpuScene& scene, std::uint32_t only_set);

/// RF-4: "radiance_filter.weights", ".filter", ".once", ".slopes". Values as before, where the weights say how much of
/// the window was taken.
gpu::ImageRef recordFilter(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           const Light& light);

/// RF-5: "radiance_filter.shade".
std::vector<Shaded> recordShading(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                                  gpu::ImageRef values, gpu::BufferRef exposure);

/// Pictures of the values, named `name`_0 to _2: a band's length each, or irradiance and gloss.
void recordViews(gpu::FrameGraph& graph, const Plan& plan, gpu::ImageRef values, gpu::BufferRef exposure,
                 const std::string& name, bool with_weights);

}  // namespace gloam::radiance_filter
