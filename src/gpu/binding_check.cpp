// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/binding_check.h"

#include "gpu/format.h"

namespace gloam::gpu {

const char* kindName(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "a storage buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "a uniform buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "a storage image";
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      return "an image with a sampler";
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "an image without a sampler";
    default:
      return "a sampler";
  }
}

namespace {

bool isBuffer(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

/// Checks one name against what stands behind it.
struct BindingCheck {
  const Device& device;
  std::string place;  ///< "pass 'room.verb', binding 'name'"
  const Binding& binding;
  const BoundResource& given;

  [[noreturn]] void fail(const std::string& why) const { throw Error(place, why); }
  void kind() const;
  void use() const;
  void buffer() const;
  void image() const;
  void run() const {
    kind();
    use();
    if (given.buffer) buffer();
    if (given.image) image();
  }
};

void BindingCheck::kind() const {
  const bool wants_buffer = isBuffer(binding.type);
  const bool wants_image = !wants_buffer && binding.type != VK_DESCRIPTOR_TYPE_SAMPLER;
  const bool sampler_alone = given.sampler && !given.image;
  const std::string shader_has = std::string("the shader has ") + kindName(binding.type) + " here";
  if (given.buffer && !wants_buffer)
    fail(shader_has + ", and buffer '" + given.buffer.name() + "' was given");
  if (given.image && !wants_image) fail(shader_has + ", and image '" + given.image.name() + "' was given");
  if (sampler_alone && binding.type != VK_DESCRIPTOR_TYPE_SAMPLER)
    fail(shader_has + ", and a sampler alone was given");
  if (!given.buffer && !given.image && !given.sampler) fail("an empty reference was given");
}

void BindingCheck::use() const {
  const bool writes = given.use == Use::kWrite || given.use == Use::kReadWrite;
  const bool storage =
      binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  if (writes && !storage) fail(std::string("is written here, but the shader has ") + kindName(binding.type));
  if (writes && !binding.writable) fail("is written here, but readonly in the shader");
  if (given.use == Use::kReadWrite && !binding.readable) fail("is read here, but writeonly in the shader");
  if (given.use == Use::kRead && storage && binding.writable) {
    fail(
        "is only read here, but the shader may write it: declare it readonly there or say write or readWrite "
        "here");
  }
  if (given.use == Use::kSample && given.image && binding.type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
    fail(std::string("is sampled here, but the shader has ") + kindName(binding.type));
  }
}

void BindingCheck::buffer() const {
  const BufferRef& ref = given.buffer;
  if (ref.bytes() < binding.block_bytes) {
    fail("the shader's block has " + std::to_string(binding.block_bytes) + " bytes, buffer '" + ref.name() +
         "' only " + std::to_string(ref.bytes()));
  }
  const Limits& limits = device.limits();
  const std::uint64_t most =
      binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? limits.max_uniform_bytes : limits.max_storage_bytes;
  if (ref.bytes() > most) {
    fail("buffer '" + ref.name() + "' has " + std::to_string(ref.bytes()) + " bytes; as " +
         kindName(binding.type) + " at most " + std::to_string(most) + " are bound at once");
  }
  if (ref.offset() % 256 != 0) {
    fail("buffer '" + ref.name() + "' is bound at " + std::to_string(ref.offset()) +
         ", not a multiple of 256");
  }
}

void BindingCheck::image() const {
  const Image& image = given.image.image();
  const ImageRange& range = given.image.range();
  const std::string its = "image '" + image.name() + "'";
  const bool is_3d = image.desc().depth > 1;
  const auto wants = [&](bool good, const char* what) {
    if (good) return;
    fail(std::string("the shader has ") + what + ", " + its + " is " + (is_3d ? "3D" : "2D") + " with " +
         std::to_string(range.layers) + " layers here");
  };
  switch (binding.view_type) {
    case VK_IMAGE_VIEW_TYPE_2D:
      wants(!is_3d && range.layers == 1, "a 2D image");
      break;
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
      wants(!is_3d, "an array of 2D images");
      break;
    case VK_IMAGE_VIEW_TYPE_3D:
      wants(is_3d, "a 3D image");
      break;
    case VK_IMAGE_VIEW_TYPE_CUBE:
      wants(image.desc().cube && range.layers == 6, "a cube");
      break;
    default:
      wants(image.desc().cube && range.layers % 6 == 0, "an array of cubes");
      break;
  }
  const FormatInfo& format = formatInfo(image.format());
  const Numbers numbers =
      format.numbers == Numbers::kUint || format.numbers == Numbers::kSint ? format.numbers : Numbers::kFloat;
  if (numbers != binding.numbers) {
    constexpr const char* kPrefix[] = {"floats", "unsigned integers", "integers"};
    const auto word = [&](Numbers n) {
      return kPrefix[n == Numbers::kUint ? 1 : n == Numbers::kSint ? 2 : 0];
    };
    fail(std::string("the shader takes texels for ") + word(binding.numbers) + ", " + its + " (" +
         format.name + ") holds " + word(numbers));
  }
  const bool storage = binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  const VkImageUsageFlags needed = storage ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
  if ((image.usage() & needed) == 0) {
    fail(its + " (" + format.name + ") cannot be " + kindName(binding.type) + " on '" + device.info().name +
         "'");
  }
  if (storage && range.mips != 1)
    fail(its + " has " + std::to_string(range.mips) + " mips here; name one with mip()");
  if (storage && binding.storage_format != VK_FORMAT_UNDEFINED && binding.storage_format != image.format()) {
    fail(std::string("the shader has the format ") + formatInfo(binding.storage_format).name + ", " + its +
         " is " + format.name);
  }
}

}  // namespace

void checkBinding(const Device& device, const std::string& place, const Binding& binding,
                  const BoundResource& given) {
  BindingCheck{device, place, binding, given}.run();
}

}  // namespace gloam::gpu
