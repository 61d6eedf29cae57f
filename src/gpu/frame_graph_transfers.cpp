// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Passes that clear and copy.
#include "gpu/format.h"
#include "gpu/frame_graph_state.h"

namespace gloam::gpu {
namespace {

constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};

VkImageSubresourceLayers layersOf(const ImageRef& ref) {
  const ImageRange& range = ref.range();
  return {formatInfo(ref.format()).aspect, static_cast<std::uint32_t>(range.mip),
          static_cast<std::uint32_t>(range.layer), static_cast<std::uint32_t>(range.layers)};
}

VkOffset3D cornerOf(const ImageRef& ref) {
  return {ref.width(), ref.height(), ref.depth()};
}

/// Where the pixels of an image stand in a buffer.
VkBufferImageCopy pixelsOf(const std::string& pass, const ImageRef& image, const BufferRef& buffer) {
  const std::string place = "pass '" + pass + "'";
  if (!image || !buffer) throw Error(place, "copies an empty reference");
  if (image.range().mips != 1)
    throw Error(place, "copies one mip between '" + image.name() + "' and a buffer");
  const std::size_t bytes =
      image.image().layerBytes(image.range().mip) * static_cast<std::size_t>(image.range().layers);
  if (bytes != buffer.bytes()) {
    throw Error(place, "copies '" + image.name() + "', " + std::to_string(bytes) + " bytes, but '" +
                           buffer.name() + "' has " + std::to_string(buffer.bytes()));
  }
  VkBufferImageCopy copy{};
  copy.bufferOffset = buffer.offset();
  copy.imageSubresource = layersOf(image);
  copy.imageExtent = {static_cast<std::uint32_t>(image.width()), static_cast<std::uint32_t>(image.height()),
                      static_cast<std::uint32_t>(image.depth())};
  return copy;
}

}  // namespace

void FrameGraph::clear(const std::string& name, ImageRef image, const ClearColor& value) {
  if (!image) throw Error("pass '" + name + "'", "clears an empty reference");
  const VkImageSubresourceRange range{
      formatInfo(image.format()).aspect, static_cast<std::uint32_t>(image.range().mip),
      static_cast<std::uint32_t>(image.range().mips), static_cast<std::uint32_t>(image.range().layer),
      static_cast<std::uint32_t>(image.range().layers)};
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(name, {{"(cleared)", image, {}, kTransferWrite, false, true}},
                      [=, &vk](VkCommandBuffer commands) {
                        if (range.aspectMask == VK_IMAGE_ASPECT_DEPTH_BIT) {
                          const VkClearDepthStencilValue depth{value.value.float32[0], 0};
                          vk.vkCmdClearDepthStencilImage(commands, image.image().handle(),
                                                         kTransferWrite.layout, &depth, 1, &range);
                        } else {
                          vk.vkCmdClearColorImage(commands, image.image().handle(), kTransferWrite.layout,
                                                  &value.value, 1, &range);
                        }
                      });
}

void FrameGraph::clear(const std::string& name, BufferRef buffer, std::uint32_t word) {
  if (!buffer) throw Error("pass '" + name + "'", "clears an empty reference");
  if (buffer.offset() % 4 != 0)
    throw Error("pass '" + name + "'", "clears from an offset that is no multiple of 4");
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(cleared)", {}, buffer, kTransferWrite, false, true}}, [=, &vk](VkCommandBuffer commands) {
        const VkDeviceSize bytes = (buffer.bytes() + 3) & ~std::size_t{3};
        if (bytes > 0) vk.vkCmdFillBuffer(commands, buffer.buffer().handle(), buffer.offset(), bytes, word);
      });
}

void FrameGraph::copy(const std::string& name, ImageRef from, ImageRef to) {
  const std::string place = "pass '" + name + "'";
  if (!from || !to) throw Error(place, "copies an empty reference");
  if (from.range().mips != 1 || to.range().mips != 1 || from.range().layers != to.range().layers) {
    throw Error(place, "copies one mip of as many layers on both sides");
  }
  const bool same = from.format() == to.format() && from.width() == to.width() &&
                    from.height() == to.height() && from.depth() == to.depth();
  if (!same && formatInfo(from.format()).aspect != VK_IMAGE_ASPECT_COLOR_BIT) {
    throw Error(place, "depth is copied only between images of the same size and format");
  }
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", from, {}, kTransferRead, true, false}, {"(to)", to, {}, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        if (same) {
          const VkImageCopy region{
              layersOf(from),
              {},
              layersOf(to),
              {},
              {static_cast<std::uint32_t>(from.width()), static_cast<std::uint32_t>(from.height()),
               static_cast<std::uint32_t>(from.depth())}};
          vk.vkCmdCopyImage(commands, from.image().handle(), kTransferRead.layout, to.image().handle(),
                            kTransferWrite.layout, 1, &region);
        } else {
          const VkImageBlit region{layersOf(from), {{}, cornerOf(from)}, layersOf(to), {{}, cornerOf(to)}};
          vk.vkCmdBlitImage(commands, from.image().handle(), kTransferRead.layout, to.image().handle(),
                            kTransferWrite.layout, 1, &region, VK_FILTER_LINEAR);
        }
      });
}

void FrameGraph::copy(const std::string& name, BufferRef from, BufferRef to) {
  if (!from || !to) throw Error("pass '" + name + "'", "copies an empty reference");
  if (from.bytes() > to.bytes()) {
    throw Error("pass '" + name + "'", "copies " + std::to_string(from.bytes()) + " bytes into the " +
                                           std::to_string(to.bytes()) + " of '" + to.name() + "'");
  }
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", {}, from, kTransferRead, true, false}, {"(to)", {}, to, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        const VkBufferCopy region{from.offset(), to.offset(), from.bytes()};
        if (region.size == 0) return;
        vk.vkCmdCopyBuffer(commands, from.buffer().handle(), to.buffer().handle(), 1, &region);
      });
}

void FrameGraph::copy(const std::string& name, ImageRef from, BufferRef to) {
  const VkBufferImageCopy region = pixelsOf(name, from, to);
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", from, {}, kTransferRead, true, false}, {"(to)", {}, to, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        vk.vkCmdCopyImageToBuffer(commands, from.image().handle(), kTransferRead.layout, to.buffer().handle(),
                                  1, &region);
      });
}

void FrameGraph::copy(const std::string& name, BufferRef from, ImageRef to) {
  const VkBufferImageCopy region = pixelsOf(name, to, from);
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", {}, from, kTransferRead, true, false}, {"(to)", to, {}, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        vk.vkCmdCopyBufferToImage(commands, from.buffer().handle(), to.image().handle(),
                                  kTransferWrite.layout, 1, &region);
      });
}

}  // namespace gloam::gpu
