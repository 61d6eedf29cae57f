// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Accessors (glTF 2.0 specification, section 3.6.2).
#include "scene/gltf_accessors.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace gloam {
namespace {

using Json = nlohmann::json;

enum ComponentType { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

template <typename T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));  // accessors of odd files are not aligned
  return value;
}

/// Throws unless `count` elements of `element` bytes, `stride` apart from `offset` on, lie in the view.
void checkFits(const GltfDocument& document, int view, std::uint64_t offset, std::uint64_t count,
               std::uint64_t stride, std::uint64_t element, const std::string& where) {
  const std::uint64_t length = document.array("bufferViews")[static_cast<std::size_t>(view)]["byteLength"];
  if (count == 0) return;
  const std::uint64_t needed = (count - 1) * stride + element;  // counts stay below 2^53: no overflow
  if (offset > length || needed > length - offset)
    document.fail(where + ".count",
                  fmt::format("{} elements from byte {} on do not fit into bufferViews[{}] ({} bytes)", count,
                              offset, view, length));
}

void checkSparse(const GltfDocument& document, const Json& accessor, std::size_t element,
                 const std::string& where) {
  const Json& sparse = accessor["sparse"];
  const std::uint64_t count = sparse["count"], of = accessor["count"];
  if (count > of)
    document.fail(where + ".count", fmt::format("{}, but the accessor has {} elements", count, of));
  const Json &indices = sparse["indices"], &values = sparse["values"];
  const std::size_t index_bytes = componentBytes(indices["componentType"]);
  checkFits(document, indices["bufferView"], indices.value("byteOffset", std::uint64_t(0)), count,
            index_bytes, index_bytes, where + ".indices");
  checkFits(document, values["bufferView"], values.value("byteOffset", std::uint64_t(0)), count, element,
            element, where + ".values");
}

}  // namespace

std::size_t componentBytes(int component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    default:
      return 4;
  }
}

int componentsOf(const std::string& type) {
  if (type == "SCALAR") return 1;
  const int n = type.back() - '0';
  return type.starts_with("MAT") ? n * n : n;
}

void checkAccessor(const GltfDocument& document, const Json& accessor, const std::string& where) {
  const std::size_t element = componentBytes(accessor["componentType"]) * componentsOf(accessor["type"]);
  const std::uint64_t count = accessor["count"];
  if (accessor.contains("bufferView")) {
    const int view = accessor["bufferView"];
    const Json& json_view = document.array("bufferViews")[static_cast<std::size_t>(view)];
    const std::uint64_t stride = json_view.value("byteStride", static_cast<std::uint64_t>(element));
    if (stride < element)
      document.fail(where, fmt::format("elements of {} bytes do not fit into bufferViews[{}].byteStride {}",
                                       element, view, stride));
    checkFits(document, view, accessor.value("byteOffset", std::uint64_t(0)), count, stride, element, where);
  }
  if (accessor.contains("sparse")) checkSparse(document, accessor, element, where + ".sparse");
}

float AccessorView::number(std::size_t element, int component) const {
  const std::uint8_t* at =
      data + element * stride + componentBytes(component_type) * static_cast<std::size_t>(component);
  switch (component_type) {
    case kByte: {
      const float value = load<std::int8_t>(at);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case kUnsignedByte:
      return normalized ? *at / 255.0f : *at;
    case kShort: {
      const float value = load<std::int16_t>(at);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case kUnsignedShort: {
      const float value = load<std::uint16_t>(at);
      return normalized ? value / 65535.0f : value;
    }
    case kUnsignedInt: {
      const auto value = static_cast<double>(load<std::uint32_t>(at));
      return static_cast<float>(normalized ? value / 4294967295.0 : value);
    }
    default:
      return load<float>(at);
  }
}

std::uint32_t AccessorView::integer(std::size_t element, int component) const {
  const std::uint8_t* at =
      data + element * stride + componentBytes(component_type) * static_cast<std::size_t>(component);
  switch (componentBytes(component_type)) {
    case 1:
      return *at;
    case 2:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

AccessorView GltfAccessors::view(int accessor) {
  const gloam_tinygltf::Accessor& source = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const Json& json = document_.json["accessors"][static_cast<std::size_t>(accessor)];
  const std::string where = fmt::format("accessors[{}]", accessor);
  AccessorView out;
  out.component_type = source.componentType;
  out.components = componentsOf(json["type"]);
  out.count = source.count;
  out.normalized = source.normalized;
  const std::size_t element = componentBytes(out.component_type) * static_cast<std::size_t>(out.components);
  out.stride = element;
  if (json.contains("bufferView") && !source.sparse.isSparse) {
    const gloam_tinygltf::BufferView& view =
        document_.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
    if (view.byteStride) out.stride = view.byteStride;
    const ByteSpan bytes = document_.view(source.bufferView);
    out.data = bytes.data() + (source.count ? source.byteOffset : 0);
    return out;
  }
  auto known = written_out_.find(accessor);
  if (known == written_out_.end()) known = written_out_.emplace(accessor, writtenOut(accessor, where)).first;
  out.data = known->second.data();
  return out;
}

Bytes GltfAccessors::writtenOut(int accessor, const std::string& where) {
  const gloam_tinygltf::Accessor& source = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const Json& json = document_.json["accessors"][static_cast<std::size_t>(accessor)];
  const std::size_t element = componentBytes(source.componentType) * componentsOf(json["type"]);
  document_.budget.charge(source.count, element, where + ".count");
  Bytes out(source.count * element);
  if (json.contains("bufferView") && source.count) {
    const gloam_tinygltf::BufferView& view =
        document_.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
    const std::size_t stride = view.byteStride ? view.byteStride : element;
    const ByteSpan bytes = document_.view(source.bufferView);
    for (std::size_t i = 0; i < source.count; ++i)
      std::memcpy(&out[i * element], bytes.data() + source.byteOffset + i * stride, element);
  }
  if (!source.sparse.isSparse) return out;

  const auto& sparse = source.sparse;
  AccessorView indices;
  indices.component_type = sparse.indices.componentType;
  indices.stride = componentBytes(sparse.indices.componentType);
  indices.data = document_.view(sparse.indices.bufferView).data() + sparse.indices.byteOffset;
  const std::uint8_t* values = document_.view(sparse.values.bufferView).data() + sparse.values.byteOffset;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
    const std::uint32_t at = indices.integer(i, 0);
    if (at >= source.count)
      document_.fail(where + ".sparse.indices",
                     fmt::format("index {} at {}, but there are {} elements", at, i, source.count));
    std::memcpy(&out[at * element], values + i * element, element);
  }
  return out;
}

std::vector<float> GltfAccessors::floats(int accessor, int components, const std::string& where) {
  const AccessorView source = view(accessor);
  if (source.components != components)
    document_.fail(where, fmt::format("accessors[{}] has {} components an element, {} were expected",
                                      accessor, source.components, components));
  document_.budget.charge(source.count, sizeof(float) * static_cast<std::size_t>(components), where);
  std::vector<float> out(source.count * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < source.count; ++i)
    for (int c = 0; c < components; ++c) {
      const float value = source.number(i, c);
      if (!std::isfinite(value))
        document_.fail(where, fmt::format("accessors[{}]: element {} is not finite", accessor, i));
      out[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)] = value;
    }
  return out;
}

}  // namespace gloam
