// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gpu/refs.h"

namespace gloam::gpu {

enum class Use : std::uint8_t { kRead, kWrite, kReadWrite, kSample };

/// One name of a shader and what stands behind it.
struct BoundResource {
  std::string name;  ///< empty: reached by address, no descriptor
  Use use = Use::kRead;
  ImageRef image;
  BufferRef buffer;
  std::optional<Sampler> sampler;
};

struct NamedConstant {
  std::string name;
  std::uint32_t word = 0;
};

/// What shaders get: resources by the names of their bindings, push constants, specialisation constants.
struct Bindings {
  std::vector<BoundResource> resources;
  std::vector<std::byte> push;
  std::vector<NamedConstant> constants;
};

/// The part of the sentence that binds. `Self` is the pass or the draw.
template <class Self>
class Binder {
 public:
  /// `readonly` buffers and images, uniform blocks, and images for texelFetch (sampler2D or texture2D).
  Self& read(std::string_view name, ImageRef image) {
    return add({std::string(name), Use::kRead, image, {}, {}});
  }
  Self& read(std::string_view name, BufferRef buffer) {
    return add({std::string(name), Use::kRead, {}, buffer, {}});
  }
  /// What is there before does not matter, or stays where this does not write.
  Self& write(std::string_view name, ImageRef image) {
    return add({std::string(name), Use::kWrite, image, {}, {}});
  }
  Self& write(std::string_view name, BufferRef buffer) {
    return add({std::string(name), Use::kWrite, {}, buffer, {}});
  }
  Self& readWrite(std::string_view name, ImageRef image) {
    return add({std::string(name), Use::kReadWrite, image, {}, {}});
  }
  Self& readWrite(std::string_view name, BufferRef buffer) {
    return add({std::string(name), Use::kReadWrite, {}, buffer, {}});
  }
  /// A sampler2D, samplerCube, sampler2DArrayShadow …
  Self& sample(std::string_view name, ImageRef image, const Sampler& sampler = kLinearClamp) {
    return add({std::string(name), Use::kSample, image, {}, sampler});
  }
  /// A sampler of its own, used with texture2D bindings.
  Self& sampler(std::string_view name, const Sampler& sampler) {
    return add({std::string(name), Use::kSample, {}, {}, sampler});
  }
  /// Memory that the shader reaches through an address (GL_EXT_buffer_reference).
  Self& readByAddress(BufferRef buffer) { return add({{}, Use::kRead, {}, buffer, {}}); }
  Self& writeByAddress(BufferRef buffer) { return add({{}, Use::kWrite, {}, buffer, {}}); }
  Self& readWriteByAddress(BufferRef buffer) { return add({{}, Use::kReadWrite, {}, buffer, {}}); }

  /// The push block; as many bytes as the shader declares.
  template <class T>
  Self& push(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bindings_.push.assign(first, first + sizeof(T));
    return self();
  }
  /// A specialisation constant by its name in GLSL: int, uint, float or bool. One pipeline a distinct set of
  /// values.
  template <class T>
  Self& specialize(std::string_view name, T value) {
    static_assert(std::is_arithmetic_v<T> && (sizeof(T) == 4 || std::is_same_v<T, bool>));
    std::uint32_t word = 0;
    if constexpr (std::is_same_v<T, bool>) {
      word = value ? 1u : 0u;
    } else {
      word = std::bit_cast<std::uint32_t>(value);
    }
    bindings_.constants.push_back({std::string(name), word});
    return self();
  }

  const Bindings& bindings() const { return bindings_; }

 private:
  Self& self() { return static_cast<Self&>(*this); }
  Self& add(BoundResource resource) {
    bindings_.resources.push_back(std::move(resource));
    return self();
  }
  Bindings bindings_;
};

}  // namespace gloam::gpu
