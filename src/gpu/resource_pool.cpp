// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/resource_pool.h"

#include <algorithm>
#include <bit>

namespace gloam::gpu {
namespace {

constexpr std::uint64_t kFramesToKeep = 16;
// Of an image, sizes besides the one that is asked for, and bytes of such a one. A viewer's pictures have two or three sizes.
constexpr std::size_t kSpareSizes = 3;
constexpr std::uint64_t kSpareBytes = 8u << 20;

bool sameDesc(const Image& image, ImageDesc desc) {
  if (desc.mips == kAllMips) desc.mips = image.desc().mips;
  return image && image.desc() == desc;
}
bool sameDesc(const Buffer& buffer, const BufferDesc& desc) {
  return buffer && buffer.desc() == desc;
}

}  // namespace

void ResourcePool::begin(std::uint64_t frame) {
  if (reset_history_) {
    image_histories_.clear();
    buffer_histories_.clear();
    reset_history_ = false;
  }
  const auto roll = [&](auto& histories) {
    std::erase_if(histories,
                  [&](const auto& item) { return item.second.used_in_frame + kFramesToKeep < frame; });
    for (auto& [name, pair] : histories) {
      // A frame that did not write its part leaves the past as it is.
      const auto& parts = pair.resources[pair.current].state().parts;
      const auto written = [&](const PartState& part) { return part.written_in_frame == frame_; };
      if (std::none_of(parts.begin(), parts.end(), written)) continue;
      pair.resources[pair.current].state().setWritten(PartState::kAlways);
      pair.current = 1 - pair.current;
      pair.resources[pair.current].state().setWritten(0);
    }
  };
  roll(image_histories_);
  roll(buffer_histories_);
  const auto evict = [&](auto& entries) {
    std::erase_if(entries,
                  [&](const auto& item) { return item.second.used_in_frame + kFramesToKeep < frame; });
  };
  evict(images_);
  evict(buffers_);
  for (auto& [name, sizes] : kept_)
    std::erase_if(sizes, [&](const Kept& kept) { return kept.used_in_frame + kFramesToKeep < frame; });
  std::erase_if(kept_, [](const auto& item) { return item.second.empty(); });
  frame_ = frame;
  names_.clear();
  image_names_.clear();
  buffer_names_.clear();
}

void ResourcePool::claim(const std::string& name) {
  if (!names_.insert(name).second)
    throw Error("frame graph", "two resources of one frame are called '" + name + "'");
}

template <class T, class Desc>
const T& ResourcePool::transient(std::map<std::string, Entry<T>>& entries, const std::string& name,
                                 const Desc& desc) {
  Entry<T>& entry = entries[name];
  entry.used_in_frame = frame_;
  if (!sameDesc(entry.resource, desc)) {
    entry.resource = T(device_, name, desc);
    entry.resource.state().setWritten(0);
  }
  return entry.resource;
}

ImageRef ResourcePool::create(const std::string& name, const ImageDesc& desc) {
  claim(name);
  return image_names_[name] = transient(images_, name, desc);
}

BufferRef ResourcePool::create(const std::string& name, const BufferDesc& desc) {
  claim(name);
  return buffer_names_[name] = transient(buffers_, name, desc);
}

BufferRef ResourcePool::createUpload(const std::string& name, std::size_t bytes) {
  claim(name);
  // Sizes that change a little from frame to frame share a buffer.
  const BufferDesc desc{.bytes = std::bit_ceil(std::max<std::size_t>(bytes, 256)), .host_writes = true};
  const bool rounded = desc.bytes <= device_.limits().max_storage_bytes;
  const Buffer& buffer = transient(buffers_, name + (frame_ % 2 == 0 ? ".even" : ".odd"),
                                   rounded ? desc : BufferDesc{.bytes = bytes, .host_writes = true});
  buffer.state().setWritten(PartState::kAlways);
  return buffer_names_[name] = BufferRef(buffer).slice(0, bytes);
}

template <class T, class Desc>
ResourcePool::Pair<T>& ResourcePool::pair(std::map<std::string, Pair<T>>& pairs, const std::string& name,
                                          const Desc& desc, bool& fresh) {
  claim(name);
  Pair<T>& pair = pairs[name];
  pair.used_in_frame = frame_;
  fresh = !sameDesc(pair.resources[0], desc);
  if (fresh) {
    pair.current = 0;
    pair.resources = {T(device_, name, desc), T(device_, name + ".previous", desc)};
    pair.resources[0].state().setWritten(0);
  }
  return pair;
}

ImageHistory ResourcePool::history(const std::string& name, const ImageDesc& desc, bool& fresh) {
  const auto& found = pair(image_histories_, name, desc, fresh);
  image_names_[name] = found.resources[found.current];
  return {found.resources[1 - found.current], found.resources[found.current]};
}

BufferHistory ResourcePool::history(const std::string& name, const BufferDesc& desc, bool& fresh) {
  const auto& found = pair(buffer_histories_, name, desc, fresh);
  buffer_names_[name] = found.resources[found.current];
  return {found.resources[1 - found.current], found.resources[found.current]};
}

/// The entry of that description. Others stay beside it where they are small, the newest of them.
ResourcePool::Kept& ResourcePool::keptOf(const std::string& name, const ImageDesc& desc) {
  std::vector<Kept>& sizes = kept_[name];
  const auto found =
      std::ranges::find_if(sizes, [&](const Kept& kept) { return sameDesc(kept.image, desc); });
  if (found != sizes.end()) return *found;
  std::erase_if(sizes, [](const Kept& kept) { return kept.image.memoryBytes() > kSpareBytes; });
  if (sizes.size() > kSpareSizes) sizes.erase(std::ranges::min_element(sizes, {}, &Kept::used_in_frame));
  return sizes.emplace_back(Kept{Image(device_, name, desc), "", 0, 0});
}

KeptImage ResourcePool::keep(const std::string& name, const ImageDesc& desc, const std::string& key) {
  claim(name);
  Kept& kept = keptOf(name, desc);
  kept.used_in_frame = frame_;
  image_names_[name] = kept.image;
  const auto written = [&](const PartState& part) {
    return part.written_in_frame == kept.keyed_in_frame || part.written_in_frame == PartState::kAlways;
  };
  const bool holds = keeps_ && !key.empty() && kept.key == key && kept.keyed_in_frame <= finished_frame_ &&
                     std::ranges::all_of(kept.image.state().parts, written);
  if (!holds) {
    kept.key = key;
    kept.keyed_in_frame = frame_;
  }
  kept.image.state().setWritten(holds ? PartState::kAlways : 0);
  return {kept.image, holds};
}

void ResourcePool::resetHistory() {
  reset_history_ = true;
}

void ResourcePool::import(const std::string& name, const ImageRef& image) {
  claim(name);
  image_names_[name] = image;
}

void ResourcePool::import(const std::string& name, const BufferRef& buffer) {
  claim(name);
  buffer_names_[name] = buffer;
}

ImageRef ResourcePool::findImage(const std::string& name) const {
  const auto found = image_names_.find(name);
  return found != image_names_.end() ? found->second : ImageRef();
}

BufferRef ResourcePool::findBuffer(const std::string& name) const {
  const auto found = buffer_names_.find(name);
  return found != buffer_names_.end() ? found->second : BufferRef();
}

std::vector<std::string> ResourcePool::imageNames() const {
  std::vector<std::string> names;
  for (const auto& [name, image] : image_names_) names.push_back(name);
  return names;
}

std::uint64_t ResourcePool::memoryBytes() const {
  std::uint64_t sum = 0;
  for (const auto& [name, entry] : images_) sum += entry.resource.memoryBytes();
  for (const auto& [name, entry] : buffers_) sum += entry.resource.bytes();
  for (const auto& [name, sizes] : kept_) {
    for (const Kept& kept : sizes) sum += kept.image.memoryBytes();
  }
  for (const auto& [name, pair] : image_histories_) {
    for (const auto& image : pair.resources) sum += image.memoryBytes();
  }
  for (const auto& [name, pair] : buffer_histories_) {
    for (const auto& buffer : pair.resources) sum += buffer.bytes();
  }
  return sum;
}

}  // namespace gloam::gpu
