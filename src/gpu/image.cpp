// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/image.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "gpu/device_state.h"
#include "gpu/format.h"

namespace gloam::gpu {
namespace {

std::string sizeText(const ImageDesc& desc) {
  return std::to_string(desc.width) + " x " + std::to_string(desc.height) + " x " +
         std::to_string(desc.depth) + ", " + std::to_string(desc.layers) + " layers, " +
         std::to_string(desc.mips) + " mips";
}

/// Everything that the format allows: whoever makes an image need not know who will use it.
VkImageUsageFlags usageOf(Device& device, const std::string& name, const ImageDesc& desc) {
  VkFormatProperties properties{};
  device.state().instance.functions.getPhysicalDeviceFormatProperties(device.physicalDevice(), desc.format,
                                                                      &properties);
  const VkFormatFeatureFlags has = properties.optimalTilingFeatures;
  VkImageUsageFlags usage = 0;
  if ((has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) != 0) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  if ((has & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  if ((has & VK_FORMAT_FEATURE_TRANSFER_SRC_BIT) != 0) usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if ((has & VK_FORMAT_FEATURE_TRANSFER_DST_BIT) != 0) usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (desc.depth == 1) {
    if ((has & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) != 0) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if ((has & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0) {
      usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    }
  }
  if (usage == 0) {
    throw Error(name, std::string("'") + device.info().name + "' has no images of format " +
                          formatInfo(desc.format).name);
  }
  return usage;
}

ImageDesc checked(const Device& device, const std::string& name, ImageDesc desc) {
  const int largest = std::max({desc.width, desc.height, desc.depth});
  const int full_mips = std::bit_width(static_cast<unsigned>(std::max(1, largest)));
  if (desc.mips == kAllMips) desc.mips = full_mips;
  const auto limit = static_cast<int>(device.limits().max_image_size);
  if (std::min({desc.width, desc.height, desc.depth, desc.layers, desc.mips}) < 1 || largest > limit) {
    throw Error(name, "an image of " + sizeText(desc) + ": sides go from 1 to " + std::to_string(limit));
  }
  if (desc.mips > full_mips) {
    throw Error(name,
                "an image of " + sizeText(desc) + " has at most " + std::to_string(full_mips) + " mips");
  }
  if (desc.depth > 1 && desc.layers > 1) throw Error(name, "a 3D image has no layers");
  if (desc.cube && (desc.width != desc.height || desc.layers % 6 != 0)) {
    throw Error(name, "a cube is square and has 6 n layers; this is " + sizeText(desc));
  }
  return desc;
}

}  // namespace

Image::Image(Device& device, std::string name, const ImageDesc& desc)
    : device_(&device), name_(std::move(name)), owned_(true), state_(std::make_unique<ResourceState>()) {
  desc_ = checked(device, name_, desc);
  usage_ = usageOf(device, name_, desc_);
  DeviceState& state = device.state();
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = desc_.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  if (desc_.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.format = desc_.format;
  info.extent = {static_cast<std::uint32_t>(desc_.width), static_cast<std::uint32_t>(desc_.height),
                 static_cast<std::uint32_t>(desc_.depth)};
  info.mipLevels = static_cast<std::uint32_t>(desc_.mips);
  info.arrayLayers = static_cast<std::uint32_t>(desc_.layers);
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage_;
  check(state.vk.vkCreateImage(state.device, &info, nullptr, &image_), name_ + " (" + sizeText(desc_) + ")",
        "vkCreateImage");
  try {
    VkMemoryRequirements requirements;
    state.vk.vkGetImageMemoryRequirements(state.device, image_, &requirements);
    memory_ = state.allocate(name_, requirements, MemoryKind::kDevice, false).memory;
    memory_bytes_ = requirements.size;
    check(state.vk.vkBindImageMemory(state.device, image_, memory_, 0), name_, "vkBindImageMemory");
    state.nameObject(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image_), name_);
    state_->parts.resize(static_cast<std::size_t>(desc_.layers) * static_cast<std::size_t>(desc_.mips));
    state.memory[image_] = {name_, memory_bytes_};
  } catch (...) {
    release();
    throw;
  }
}

Image Image::adopt(Device& device, std::string name, VkImage handle, const ImageDesc& desc,
                   VkImageUsageFlags usage, VkImageLayout layout) {
  Image image;
  image.device_ = &device;
  image.name_ = std::move(name);
  image.desc_ = checked(device, image.name_, desc);
  image.image_ = handle;
  image.usage_ = usage;
  image.state_ = std::make_unique<ResourceState>();
  PartState part;
  // Whatever the owner did with it before this frame was submitted counts as a write that all must wait for.
  part.write = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, layout};
  image.state_->parts.assign(
      static_cast<std::size_t>(image.desc_.layers) * static_cast<std::size_t>(image.desc_.mips), part);
  return image;
}

Image::Image(Image&& other) noexcept {
  *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
  if (this == &other) return *this;
  release();
  device_ = other.device_;
  name_ = std::move(other.name_);
  desc_ = other.desc_;
  image_ = std::exchange(other.image_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  usage_ = other.usage_;
  memory_bytes_ = other.memory_bytes_;
  owned_ = other.owned_;
  views_ = std::exchange(other.views_, {});
  state_ = std::move(other.state_);
  return *this;
}

Image::~Image() {
  release();
}

void Image::release() noexcept {
  if (image_ == VK_NULL_HANDLE) return;
  DeviceState& state = device_->state();
  state.memory.erase(image_);
  state.retire(
      [&state, views = std::move(views_), image = owned_ ? image_ : VK_NULL_HANDLE, memory = memory_] {
        for (const auto& view : views) state.vk.vkDestroyImageView(state.device, view.view, nullptr);
        state.vk.vkDestroyImage(state.device, image, nullptr);
        state.vk.vkFreeMemory(state.device, memory, nullptr);
      });
  image_ = VK_NULL_HANDLE;
}

VkImageView Image::view(VkImageViewType type, const ImageRange& range) const {
  for (const auto& known : views_) {
    if (known.type == type && known.range == range) return known.view;
  }
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image_;
  info.viewType = type;
  info.format = desc_.format;
  info.subresourceRange = {formatInfo(desc_.format).aspect, static_cast<std::uint32_t>(range.mip),
                           static_cast<std::uint32_t>(range.mips), static_cast<std::uint32_t>(range.layer),
                           static_cast<std::uint32_t>(range.layers)};
  VkImageView view = VK_NULL_HANDLE;
  check(device_->vk().vkCreateImageView(device_->handle(), &info, nullptr, &view), name_,
        "vkCreateImageView");
  device_->state().nameObject(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<std::uint64_t>(view), name_);
  views_.push_back({type, range, view});
  return view;
}

}  // namespace gloam::gpu
