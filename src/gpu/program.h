// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/reflection.h"

namespace gloam::gpu {

enum class Blend : std::uint8_t { kNone, kAdd, kAlphaOver, kMultiply };

/// Fixed-function state of a draw. Front faces are counter-clockwise in the picture as it is stored, top row
/// first.
struct RasterState {
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  VkFrontFace front = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  bool depth_test = true, depth_write = true;  ///< used where the pass has a depth attachment
  VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
  float depth_bias_constant = 0.0f, depth_bias_slope = 0.0f;
  bool depth_clamp = false;  ///< where the device has it
  Blend blend = Blend::kNone;
  bool wireframe = false;  ///< where the device has it
  bool operator==(const RasterState&) const = default;
};

/// Formats of what a raster pass draws into, by location; UNDEFINED where a location is not used.
struct AttachmentFormats {
  std::vector<VkFormat> colors;
  VkFormat depth = VK_FORMAT_UNDEFINED;
  bool operator==(const AttachmentFormats&) const = default;
};

/// Values of specialisation constants, by constant id, as 32-bit words.
using Specialization = std::map<std::uint32_t, std::uint32_t>;

/// One compute shader, or a vertex shader with or without a fragment shader: its interface, its layouts and
/// its pipelines. Made once a device by programFor and kept by it.
class Program {
 public:
  /// One stage (compute) or one or two (vertex, fragment).
  Program(Device& device, std::vector<const ShaderCode*> stages);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  const Interface& interface() const { return interface_; }
  VkPipelineLayout layout() const { return layout_; }
  const std::vector<VkDescriptorSetLayout>& setLayouts() const { return set_layouts_; }
  bool isCompute() const;

  VkPipeline computePipeline(const Specialization& constants);
  VkPipeline rasterPipeline(const Specialization& constants, const RasterState& state,
                            const AttachmentFormats& attachments);

 private:
  struct RasterVariant {
    Specialization constants;
    RasterState state;
    AttachmentFormats attachments;
    VkPipeline pipeline;
  };
  void createLayouts();
  VkPipeline createRasterPipeline(const RasterVariant& variant);

  Device& device_;
  std::vector<const ShaderCode*> stages_;
  std::vector<VkShaderModule> modules_;
  Interface interface_;
  std::vector<VkDescriptorSetLayout> set_layouts_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::map<Specialization, VkPipeline> compute_pipelines_;
  std::vector<RasterVariant> raster_pipelines_;
};

/// The device's program of these stages; made at first use.
Program& programFor(Device& device, const std::vector<const ShaderCode*>& stages);

}  // namespace gloam::gpu
