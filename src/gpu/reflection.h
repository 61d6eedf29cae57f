// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <volk.h>

#include <array>
#include <string>
#include <vector>

#include "gpu/format.h"
#include "gpu/shader_code.h"

namespace gloam::gpu {

/// A member of a block, with the path that leads to it: "proxies[].centre".
struct BlockMember {
  std::string name;
  std::uint32_t offset = 0;  ///< in bytes from the start of the block, or of the innermost array element
  std::uint32_t bytes = 0;   ///< 0 for arrays without a length
  std::uint32_t array_stride = 0;
};

/// A descriptor. Blocks are known by the name of their instance; without one, by the name of the block.
struct Binding {
  std::string name;
  std::uint32_t set = 0, binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  VkShaderStageFlags stages = 0;
  bool readable = true,
       writable = false;          ///< storage only: neither `writeonly` nor `readonly` in GLSL means both
  std::uint32_t block_bytes = 0;  ///< least size of a block
  std::vector<BlockMember> members;
  VkImageViewType view_type = VK_IMAGE_VIEW_TYPE_2D;  ///< images
  VkFormat storage_format = VK_FORMAT_UNDEFINED;      ///< storage images with a format
  Numbers numbers = Numbers::kFloat;  ///< kFloat, kUint or kSint: what the shader takes a texel for
};

struct StageOutput {
  std::string name;
  std::uint32_t location = 0;
};

struct SpecConstant {
  std::string name;
  std::uint32_t id = 0;
};

/// What a program asks for, read from its SPIR-V.
struct Interface {
  std::string name;  ///< of the shaders, for messages
  std::vector<Binding> bindings;
  std::uint32_t push_bytes = 0;
  VkShaderStageFlags push_stages = 0;
  std::vector<BlockMember> push_members;
  std::array<std::uint32_t, 3> local_size{1, 1, 1};
  std::array<std::uint32_t, 3> local_size_id{~0u, ~0u, ~0u};  ///< constant ids that replace local_size
  std::vector<SpecConstant> constants;
  std::vector<StageOutput> outputs;  ///< of the fragment stage
  VkShaderStageFlags stages = 0;

  const Binding* find(const std::string& binding) const;
};

/// Reads the interface of one stage. Throws Error that names the shader for what this library does not
/// handle: vertex attributes (vertices are pulled from storage buffers), arrays of descriptors.
Interface reflect(const ShaderCode& code);
/// Joins the stages of a program; throws Error where they disagree about a name or a binding.
Interface join(const Interface& a, const Interface& b);

}  // namespace gloam::gpu
