// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels in and out of images, outside of frames.
#include <algorithm>
#include <cstring>

#include "gpu/buffer.h"
#include "gpu/device_state.h"
#include "gpu/format.h"
#include "gpu/image.h"

namespace gloam::gpu {
namespace {

constexpr Access kCopyTo{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr Access kCopyFrom{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

int mipSide(int side, int mip) {
  return std::max(1, side >> mip);
}

VkBufferImageCopy wholeLayer(const Image& image, int mip, int layer) {
  const ImageDesc& desc = image.desc();
  VkBufferImageCopy copy{};
  copy.imageSubresource = {formatInfo(desc.format).aspect, static_cast<std::uint32_t>(mip),
                           static_cast<std::uint32_t>(layer), 1};
  copy.imageExtent = {static_cast<std::uint32_t>(mipSide(desc.width, mip)),
                      static_cast<std::uint32_t>(mipSide(desc.height, mip)),
                      static_cast<std::uint32_t>(mipSide(desc.depth, mip))};
  return copy;
}

void checkLayer(const Image& image, int mip, int layer, std::size_t bytes) {
  const ImageDesc& desc = image.desc();
  if (mip < 0 || mip >= desc.mips || layer < 0 || layer >= desc.layers) {
    throw Error(image.name(), "has no mip " + std::to_string(mip) + " of layer " + std::to_string(layer));
  }
  if (bytes != image.layerBytes(mip)) {
    throw Error(image.name(), "mip " + std::to_string(mip) + " holds " +
                                  std::to_string(image.layerBytes(mip)) + " bytes a layer, not " +
                                  std::to_string(bytes));
  }
}

}  // namespace

std::size_t Image::layerBytes(int mip) const {
  return static_cast<std::size_t>(mipSide(desc_.width, mip)) *
         static_cast<std::size_t>(mipSide(desc_.height, mip)) *
         static_cast<std::size_t>(mipSide(desc_.depth, mip)) *
         static_cast<std::size_t>(formatInfo(desc_.format).bytes);
}

void Image::uploadBytes(std::span<const std::byte> data, int mip, int layer) {
  checkLayer(*this, mip, layer, data.size());
  Buffer staging(*device_, name_ + ".staging",
                 BufferDesc{.bytes = data.size(),
                            .host_visible = true,
                            .by_address = device_->features().buffer_device_address});
  std::memcpy(staging.mapped(), data.data(), data.size());
  device_->runNow([&](VkCommandBuffer commands) {
    BarrierBatch barriers;
    barriers.add(*this, {mip, 1, layer, 1}, kCopyTo);
    barriers.record(*device_, commands);
    const VkBufferImageCopy copy = wholeLayer(*this, mip, layer);
    device_->vk().vkCmdCopyBufferToImage(commands, staging.handle(), image_, kCopyTo.layout, 1, &copy);
  });
}

Buffer Image::downloaded(int mip, int layer) const {
  Buffer staging(*device_, name_ + ".staging",
                 BufferDesc{.bytes = layerBytes(mip),
                            .host_visible = true,
                            .by_address = device_->features().buffer_device_address});
  device_->runNow([&](VkCommandBuffer commands) {
    BarrierBatch barriers;
    barriers.add(*this, {mip, 1, layer, 1}, kCopyFrom);
    barriers.record(*device_, commands);
    const VkBufferImageCopy copy = wholeLayer(*this, mip, layer);
    device_->vk().vkCmdCopyImageToBuffer(commands, image_, kCopyFrom.layout, staging.handle(), 1, &copy);
  });
  return staging;
}

void Image::downloadBytes(std::span<std::byte> data, int mip, int layer) const {
  checkLayer(*this, mip, layer, data.size());
  const Buffer staging = downloaded(mip, layer);
  std::memcpy(data.data(), staging.mapped(), data.size());
}

std::vector<float> Image::downloadFloats(int mip, int layer, int channels) const {
  const std::size_t bytes = layerBytes(mip);
  checkLayer(*this, mip, layer, bytes);
  const Buffer staging = downloaded(mip, layer);
  return floatsFromPixels(desc_.format, {static_cast<const std::byte*>(staging.mapped()), bytes}, channels);
}

void Image::uploadFloats(std::span<const float> values, int mip, int layer) {
  uploadBytes(pixelsFromFloats(desc_.format, values), mip, layer);
}

void Image::generateMips() {
  if (desc_.mips == 1) return;
  VkFormatProperties properties{};
  device_->state().instance.functions.getPhysicalDeviceFormatProperties(device_->physicalDevice(),
                                                                        desc_.format, &properties);
  constexpr VkFormatFeatureFlags kNeeded = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT |
                                           VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  if ((properties.optimalTilingFeatures & kNeeded) != kNeeded) {
    throw Error(name_,
                std::string("mips of ") + formatInfo(desc_.format).name + " cannot be made by filtering");
  }
  const auto corner = [&](int mip) {
    return VkOffset3D{mipSide(desc_.width, mip), mipSide(desc_.height, mip), mipSide(desc_.depth, mip)};
  };
  device_->runNow([&](VkCommandBuffer commands) {
    for (int mip = 1; mip < desc_.mips; ++mip) {
      BarrierBatch barriers;
      barriers.add(*this, {mip - 1, 1, 0, desc_.layers}, kCopyFrom);
      barriers.add(*this, {mip, 1, 0, desc_.layers}, kCopyTo);
      barriers.record(*device_, commands);
      VkImageBlit blit{};
      blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, static_cast<std::uint32_t>(mip - 1), 0,
                             static_cast<std::uint32_t>(desc_.layers)};
      blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, static_cast<std::uint32_t>(mip), 0,
                             static_cast<std::uint32_t>(desc_.layers)};
      blit.srcOffsets[1] = corner(mip - 1);
      blit.dstOffsets[1] = corner(mip);
      device_->vk().vkCmdBlitImage(commands, image_, kCopyFrom.layout, image_, kCopyTo.layout, 1, &blit,
                                   VK_FILTER_LINEAR);
    }
  });
}

}  // namespace gloam::gpu
