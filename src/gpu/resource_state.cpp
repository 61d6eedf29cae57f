// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/resource_state.h"

#include "gpu/buffer.h"
#include "gpu/format.h"
#include "gpu/image.h"

namespace gloam::gpu {
namespace {

constexpr VkAccessFlags2 kWriteAccess =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

struct Dependency {
  bool needed = false;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

/// What `next` has to wait for; moves the state on.
Dependency advance(PartState& part, const Access& next) {
  Dependency dependency;
  dependency.old_layout = part.write.layout;
  const bool transition = part.write.layout != next.layout;
  if (next.writes() || transition) {
    dependency.stages = part.write.stages | part.reads;
    dependency.access = part.write.access & kWriteAccess;
    dependency.needed = transition || dependency.stages != 0;
    part.write = next;
    part.reads = next.writes() ? VkPipelineStageFlags2{0} : next.stages;
    // A transition made for a reader is visible to that reader; what a pass writes is visible to nobody yet.
    part.visible_stages = next.writes() ? VkPipelineStageFlags2{0} : next.stages;
    part.visible_access = next.writes() ? VkAccessFlags2{0} : next.access;
    return dependency;
  }
  const bool visible = (next.stages & ~part.visible_stages) == 0 && (next.access & ~part.visible_access) == 0;
  part.reads |= next.stages;
  if (visible || part.write.stages == 0) return dependency;
  dependency.needed = true;
  dependency.stages = part.write.stages;
  dependency.access = part.write.access & kWriteAccess;
  // Only pairs of a stage and an access that were made visible together may be taken for visible.
  part.visible_stages = part.visible_access == next.access ? part.visible_stages | next.stages : next.stages;
  part.visible_access = next.access;
  return dependency;
}

}  // namespace

bool Access::writes() const {
  return (access & kWriteAccess) != 0;
}

bool PartState::sameAccess(const PartState& other) const {
  return write.stages == other.write.stages && write.access == other.write.access &&
         write.layout == other.write.layout && reads == other.reads &&
         visible_stages == other.visible_stages && visible_access == other.visible_access;
}

void BarrierBatch::add(const Image& image, const ImageRange& range, const Access& access) {
  auto& parts = image.state().parts;
  const auto mips = static_cast<std::size_t>(image.desc().mips);
  const auto part = [&](int layer, int mip) -> PartState& {
    return parts[static_cast<std::size_t>(layer) * mips + static_cast<std::size_t>(mip)];
  };
  bool uniform = true;
  const PartState first = part(range.layer, range.mip);
  for (int layer = range.layer; layer < range.layer + range.layers; ++layer) {
    for (int mip = range.mip; mip < range.mip + range.mips; ++mip)
      uniform &= part(layer, mip).sameAccess(first);
  }
  const auto push = [&](const Dependency& dependency, const ImageRange& of) {
    if (!dependency.needed) return;
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = dependency.stages;
    barrier.srcAccessMask = dependency.access;
    barrier.dstStageMask = access.stages;
    barrier.dstAccessMask = access.access;
    barrier.oldLayout = dependency.old_layout;
    barrier.newLayout = access.layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {formatInfo(image.format()).aspect, static_cast<std::uint32_t>(of.mip),
                                static_cast<std::uint32_t>(of.mips), static_cast<std::uint32_t>(of.layer),
                                static_cast<std::uint32_t>(of.layers)};
    images_.push_back(barrier);
  };
  Dependency last;
  for (int layer = range.layer; layer < range.layer + range.layers; ++layer) {
    for (int mip = range.mip; mip < range.mip + range.mips; ++mip) {
      last = advance(part(layer, mip), access);
      if (!uniform) push(last, {mip, 1, layer, 1});
    }
  }
  if (uniform) push(last, range);
}

void BarrierBatch::add(const Buffer& buffer, const Access& access) {
  Access next = access;
  next.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  const Dependency dependency = advance(buffer.state().parts[0], next);
  if (!dependency.needed) return;
  memory_.srcStageMask |= dependency.stages;
  memory_.srcAccessMask |= dependency.access;
  memory_.dstStageMask |= next.stages;
  memory_.dstAccessMask |= next.access;
}

void BarrierBatch::record(Device& device, VkCommandBuffer commands) {
  if (images_.empty() && memory_.dstStageMask == 0) return;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = memory_.dstStageMask != 0 ? 1 : 0;
  info.pMemoryBarriers = &memory_;
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(images_.size());
  info.pImageMemoryBarriers = images_.data();
  device.vk().vkCmdPipelineBarrier2(commands, &info);
  images_.clear();
  memory_ = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
}

}  // namespace gloam::gpu
