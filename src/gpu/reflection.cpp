// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/reflection.h"

#include <gloam/error.h>
#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <span>

namespace gloam::gpu {
namespace {

struct Reader {
  spvc_compiler compiler;
  const ShaderCode& code;
  Interface& out;

  std::string name(std::uint32_t id) const { return spvc_compiler_get_name(compiler, id); }
  unsigned decoration(std::uint32_t id, SpvDecoration which) const {
    return spvc_compiler_get_decoration(compiler, id, which);
  }

  void readMembers(spvc_type type, const std::string& prefix, std::uint32_t base,
                   std::vector<BlockMember>& members);
  void readBlock(const spvc_reflected_resource& resource, VkDescriptorType type);
  void readImage(const spvc_reflected_resource& resource, VkDescriptorType type);
  void readPush(const spvc_reflected_resource& resource);
  Binding common(const spvc_reflected_resource& resource, VkDescriptorType type) const;
  void readConstants();
};

/// GLSL's "instance" of a block, or the block's own name where it has none.
std::string resourceName(const Reader& reader, const spvc_reflected_resource& resource) {
  const std::string instance = reader.name(resource.id);
  return instance.empty() ? reader.name(resource.base_type_id) : instance;
}

void Reader::readMembers(spvc_type type, const std::string& prefix, std::uint32_t base,
                         std::vector<BlockMember>& members) {
  const spvc_type_id type_id = spvc_type_get_base_type_id(type);
  for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
    const spvc_type member_type = spvc_compiler_get_type_handle(compiler, spvc_type_get_member_type(type, i));
    unsigned offset = 0;
    spvc_compiler_type_struct_member_offset(compiler, type, i, &offset);
    BlockMember member;
    member.name = prefix + spvc_compiler_get_member_name(compiler, type_id, i);
    member.offset = base + offset;
    const bool array = spvc_type_get_num_array_dimensions(member_type) > 0;
    const bool endless = array && spvc_type_get_array_dimension(member_type, 0) == 0;
    if (!endless) {
      std::size_t bytes = 0;
      spvc_compiler_get_declared_struct_member_size(compiler, type, i, &bytes);
      member.bytes = static_cast<std::uint32_t>(bytes);
    }
    if (array) spvc_compiler_type_struct_member_array_stride(compiler, type, i, &member.array_stride);
    members.push_back(member);
    if (spvc_type_get_basetype(member_type) == SPVC_BASETYPE_STRUCT) {
      const spvc_type inner =
          spvc_compiler_get_type_handle(compiler, spvc_type_get_base_type_id(member_type));
      readMembers(inner, member.name + (array ? "[]." : "."), array ? 0 : member.offset, members);
    }
  }
}

Binding Reader::common(const spvc_reflected_resource& resource, VkDescriptorType type) const {
  Binding binding;
  binding.name = resourceName(*this, resource);
  binding.set = decoration(resource.id, SpvDecorationDescriptorSet);
  binding.binding = decoration(resource.id, SpvDecorationBinding);
  binding.type = type;
  binding.stages = out.stages;
  const spvc_type full = spvc_compiler_get_type_handle(compiler, resource.type_id);
  if (spvc_type_get_num_array_dimensions(full) > 0) {
    throw Error(code.name,
                "binding '" + binding.name +
                    "' is an array of descriptors, which not every device can index; use an image array");
  }
  return binding;
}

void Reader::readBlock(const spvc_reflected_resource& resource, VkDescriptorType type) {
  Binding binding = common(resource, type);
  const SpvDecoration* decorations = nullptr;
  std::size_t count = 0;
  spvc_compiler_get_buffer_block_decorations(compiler, resource.id, &decorations, &count);
  const auto has = [&](SpvDecoration which) {
    return std::find(decorations, decorations + count, which) != decorations + count;
  };
  binding.writable = type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER && !has(SpvDecorationNonWritable);
  binding.readable = !has(SpvDecorationNonReadable);
  const spvc_type block = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
  std::size_t bytes = 0;
  spvc_compiler_get_declared_struct_size(compiler, block, &bytes);
  binding.block_bytes = static_cast<std::uint32_t>(bytes);
  readMembers(block, "", 0, binding.members);
  out.bindings.push_back(std::move(binding));
}

VkFormat storageFormat(SpvImageFormat format) {
  switch (format) {
    case SpvImageFormatRgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case SpvImageFormatRgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case SpvImageFormatR32f:
      return VK_FORMAT_R32_SFLOAT;
    case SpvImageFormatRgba8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case SpvImageFormatRgba8Snorm:
      return VK_FORMAT_R8G8B8A8_SNORM;
    case SpvImageFormatRg32f:
      return VK_FORMAT_R32G32_SFLOAT;
    case SpvImageFormatRg16f:
      return VK_FORMAT_R16G16_SFLOAT;
    case SpvImageFormatR11fG11fB10f:
      return VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    case SpvImageFormatR16f:
      return VK_FORMAT_R16_SFLOAT;
    case SpvImageFormatRgba16:
      return VK_FORMAT_R16G16B16A16_UNORM;
    case SpvImageFormatRgb10A2:
      return VK_FORMAT_A2B10G10R10_UNORM_PACK32;
    case SpvImageFormatRg16:
      return VK_FORMAT_R16G16_UNORM;
    case SpvImageFormatRg8:
      return VK_FORMAT_R8G8_UNORM;
    case SpvImageFormatR16:
      return VK_FORMAT_R16_UNORM;
    case SpvImageFormatR8:
      return VK_FORMAT_R8_UNORM;
    case SpvImageFormatRgba16Snorm:
      return VK_FORMAT_R16G16B16A16_SNORM;
    case SpvImageFormatRg16Snorm:
      return VK_FORMAT_R16G16_SNORM;
    case SpvImageFormatR32i:
      return VK_FORMAT_R32_SINT;
    case SpvImageFormatRgba32ui:
      return VK_FORMAT_R32G32B32A32_UINT;
    case SpvImageFormatRgba16ui:
      return VK_FORMAT_R16G16B16A16_UINT;
    case SpvImageFormatRgba8ui:
      return VK_FORMAT_R8G8B8A8_UINT;
    case SpvImageFormatR32ui:
      return VK_FORMAT_R32_UINT;
    case SpvImageFormatRg32ui:
      return VK_FORMAT_R32G32_UINT;
    case SpvImageFormatRg16ui:
      return VK_FORMAT_R16G16_UINT;
    case SpvImageFormatR16ui:
      return VK_FORMAT_R16_UINT;
    case SpvImageFormatR8ui:
      return VK_FORMAT_R8_UINT;
    default:
      return VK_FORMAT_UNDEFINED;
  }
}

void Reader::readImage(const spvc_reflected_resource& resource, VkDescriptorType type) {
  Binding binding = common(resource, type);
  if (type != VK_DESCRIPTOR_TYPE_SAMPLER) {
    const spvc_type image = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
    const bool arrayed = spvc_type_get_image_arrayed(image);
    switch (spvc_type_get_image_dimension(image)) {
      case SpvDim2D:
        binding.view_type = arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        break;
      case SpvDim3D:
        binding.view_type = VK_IMAGE_VIEW_TYPE_3D;
        break;
      case SpvDimCube:
        binding.view_type = arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
        break;
      default:
        throw Error(code.name, "binding '" + binding.name + "' is neither a 2D, 3D nor cube image");
    }
    const spvc_type texel = spvc_compiler_get_type_handle(compiler, spvc_type_get_image_sampled_type(image));
    const spvc_basetype base = spvc_type_get_basetype(texel);
    binding.numbers = base == SPVC_BASETYPE_UINT32  ? Numbers::kUint
                      : base == SPVC_BASETYPE_INT32 ? Numbers::kSint
                                                    : Numbers::kFloat;
    if (type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
      binding.storage_format = storageFormat(spvc_type_get_image_storage_format(image));
      binding.writable = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonWritable);
      binding.readable = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonReadable);
    }
  }
  out.bindings.push_back(std::move(binding));
}

void Reader::readPush(const spvc_reflected_resource& resource) {
  const spvc_type block = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
  std::size_t bytes = 0;
  spvc_compiler_get_declared_struct_size(compiler, block, &bytes);
  out.push_bytes = static_cast<std::uint32_t>(bytes);
  out.push_stages = out.stages;
  readMembers(block, "", 0, out.push_members);
}

void Reader::readConstants() {
  const spvc_specialization_constant* constants = nullptr;
  std::size_t count = 0;
  spvc_compiler_get_specialization_constants(compiler, &constants, &count);
  for (std::size_t i = 0; i < count; ++i) {
    out.constants.push_back({name(constants[i].id), constants[i].constant_id});
  }
  if (out.stages != VK_SHADER_STAGE_COMPUTE_BIT) return;
  spvc_specialization_constant size[3]{};
  spvc_compiler_get_work_group_size_specialization_constants(compiler, &size[0], &size[1], &size[2]);
  for (unsigned i = 0; i < 3; ++i) {
    out.local_size[i] =
        spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, i);
    if (size[i].id != 0) {
      out.local_size_id[i] = size[i].constant_id;
      out.local_size[i] =
          spvc_constant_get_scalar_u32(spvc_compiler_get_constant_handle(compiler, size[i].id), 0, 0);
    }
  }
}

}  // namespace

const Binding* Interface::find(const std::string& binding) const {
  for (const auto& candidate : bindings) {
    if (candidate.name == binding) return &candidate;
  }
  return nullptr;
}

Interface reflect(const ShaderCode& code) {
  spvc_context raw_context = nullptr;
  if (spvc_context_create(&raw_context) != SPVC_SUCCESS)
    throw Error(code.name, "SPIRV-Cross could not start");
  const std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)> context(raw_context,
                                                                                 spvc_context_destroy);
  spvc_parsed_ir ir = nullptr;
  spvc_compiler compiler = nullptr;
  spvc_resources resources = nullptr;
  if (spvc_context_parse_spirv(raw_context, code.words, code.word_count, &ir) != SPVC_SUCCESS ||
      spvc_context_create_compiler(raw_context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                   &compiler) != SPVC_SUCCESS ||
      spvc_compiler_create_shader_resources(compiler, &resources) != SPVC_SUCCESS) {
    throw Error(code.name, std::string("is not SPIR-V: ") + spvc_context_get_last_error_string(raw_context));
  }
  Interface out;
  out.name = code.name;
  switch (spvc_compiler_get_execution_model(compiler)) {
    case SpvExecutionModelGLCompute:
      out.stages = VK_SHADER_STAGE_COMPUTE_BIT;
      break;
    case SpvExecutionModelVertex:
      out.stages = VK_SHADER_STAGE_VERTEX_BIT;
      break;
    case SpvExecutionModelFragment:
      out.stages = VK_SHADER_STAGE_FRAGMENT_BIT;
      break;
    default:
      throw Error(code.name, "is neither a compute, vertex nor fragment shader");
  }
  Reader reader{compiler, code, out};
  const auto list = [&](spvc_resource_type type) {
    const spvc_reflected_resource* found = nullptr;
    std::size_t count = 0;
    spvc_resources_get_resource_list_for_type(resources, type, &found, &count);
    return std::span(found, count);
  };
  for (const auto& r : list(SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) {
    reader.readBlock(r, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  }
  for (const auto& r : list(SPVC_RESOURCE_TYPE_UNIFORM_BUFFER)) {
    reader.readBlock(r, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  }
  for (const auto& r : list(SPVC_RESOURCE_TYPE_STORAGE_IMAGE)) {
    reader.readImage(r, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  }
  for (const auto& r : list(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE)) {
    reader.readImage(r, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  }
  for (const auto& r : list(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE)) {
    reader.readImage(r, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  }
  for (const auto& r : list(SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS))
    reader.readImage(r, VK_DESCRIPTOR_TYPE_SAMPLER);
  for (const auto& r : list(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) reader.readPush(r);
  if (out.stages == VK_SHADER_STAGE_VERTEX_BIT) {
    for (const auto& r : list(SPVC_RESOURCE_TYPE_STAGE_INPUT)) {
      throw Error(code.name, "reads the vertex attribute '" + reader.name(r.id) +
                                 "'; vertices are pulled from storage buffers by gl_VertexIndex");
    }
  }
  if (out.stages == VK_SHADER_STAGE_FRAGMENT_BIT) {
    for (const auto& r : list(SPVC_RESOURCE_TYPE_STAGE_OUTPUT)) {
      out.outputs.push_back({reader.name(r.id), reader.decoration(r.id, SpvDecorationLocation)});
    }
  }
  reader.readConstants();
  std::sort(out.bindings.begin(), out.bindings.end(), [](const Binding& a, const Binding& b) {
    return std::pair(a.set, a.binding) < std::pair(b.set, b.binding);
  });
  return out;
}

Interface join(const Interface& a, const Interface& b) {
  Interface joined = a;
  joined.name = a.name + " + " + b.name;
  joined.stages |= b.stages;
  for (const auto& binding : b.bindings) {
    const auto same_name = [&](const Binding& other) { return other.name == binding.name; };
    const auto same_slot = [&](const Binding& other) {
      return other.set == binding.set && other.binding == binding.binding;
    };
    auto& known = joined.bindings;
    const auto by_name = std::find_if(known.begin(), known.end(), same_name);
    const auto by_slot = std::find_if(known.begin(), known.end(), same_slot);
    if (by_name != by_slot || (by_name != known.end() && by_name->type != binding.type)) {
      throw Error(joined.name, "the stages disagree about binding '" + binding.name + "' (set " +
                                   std::to_string(binding.set) + ", binding " +
                                   std::to_string(binding.binding) + ")");
    }
    if (by_name == known.end()) {
      known.push_back(binding);
    } else {
      by_name->stages |= binding.stages;
      by_name->readable |= binding.readable;
      by_name->writable |= binding.writable;
      by_name->block_bytes = std::max(by_name->block_bytes, binding.block_bytes);
    }
  }
  if (a.push_bytes != 0 && b.push_bytes != 0 && a.push_bytes != b.push_bytes) {
    throw Error(joined.name, "the stages have push blocks of " + std::to_string(a.push_bytes) + " and " +
                                 std::to_string(b.push_bytes) + " bytes; give both the same");
  }
  joined.push_bytes = std::max(a.push_bytes, b.push_bytes);
  joined.push_stages |= b.push_stages;
  if (joined.push_members.empty()) joined.push_members = b.push_members;
  for (const auto& constant : b.constants) {
    for (const auto& known : joined.constants) {
      if ((known.id == constant.id) != (known.name == constant.name)) {
        throw Error(joined.name, "the stages disagree about the constant '" + constant.name + "'");
      }
    }
    joined.constants.push_back(constant);
  }
  joined.outputs = b.outputs;
  return joined;
}

}  // namespace gloam::gpu
