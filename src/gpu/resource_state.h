// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <volk.h>

#include <cstdint>
#include <vector>

namespace gloam::gpu {

class Device;
class Image;
class Buffer;
struct ImageRange;

/// How a pass touches a resource: where in the pipeline, with which kind of access, in which layout (images).
struct Access {
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 access = VK_ACCESS_2_NONE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool writes() const;
};

/// What the device did last with one part of a resource: the last write and all reads since.
struct PartState {
  /// Parts that hold data from elsewhere may be read in any frame.
  static constexpr std::uint64_t kAlways = ~std::uint64_t{0};

  Access write;                              ///< `layout` is the current layout of the part
  VkPipelineStageFlags2 reads = 0;           ///< stages that read since the last write
  VkPipelineStageFlags2 visible_stages = 0;  ///< where the last write has been made visible …
  VkAccessFlags2 visible_access = 0;         ///< … and to which accesses
  std::uint64_t written_in_frame = kAlways;  ///< frame in which a pass last wrote or cleared it, else kAlways
  bool sameAccess(const PartState& other) const;
};

/// State of a resource: one part for a buffer, layers * mips parts for an image (part = layer * mips + mip).
struct ResourceState {
  std::vector<PartState> parts;

  void setWritten(std::uint64_t frame) {
    for (auto& part : parts) part.written_in_frame = frame;
  }
};

/// Barriers that make the next accesses safe after all that went before, gathered and recorded as one.
class BarrierBatch {
 public:
  void add(const Image& image, const ImageRange& range, const Access& access);
  void add(const Buffer& buffer, const Access& access);
  void record(Device& device, VkCommandBuffer commands);

 private:
  std::vector<VkImageMemoryBarrier2> images_;
  VkMemoryBarrier2 memory_{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
};

}  // namespace gloam::gpu
