// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// EXT_meshopt_compression works on buffer views: a bitstream, then a filter (the extension's appendices A and B).
// KHR_draco_mesh_compression works on primitives: a bitstream 2.2 with connectivity and attributes.
#include "scene/gltf_compression.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstring>

#include "image/limits.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

/// Draco allocates by the counts in its header: hold them against the budget first (bitstream specification, "Draco header",
/// "metadata" and "connectivity").
void chargeDracoCounts(GltfDocument& document, ByteSpan data, const std::string& where) {
  constexpr std::size_t kHeader = 11;
  if (data.size() <= kHeader || std::memcmp(data.data(), "DRACO", 5) != 0)
    document.fail(where, "no Draco data");
  if (data[5] != 2 || data[6] != 2)
    document.fail(where, fmt::format("Draco bitstream 2.2 was expected, found {}.{}", data[5], data[6]));
  if (data[7] != draco::TRIANGULAR_MESH) document.fail(where, "the Draco data holds no mesh");
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data()), data.size(), DRACO_BITSTREAM_VERSION(2, 2));
  buffer.Advance(kHeader);
  draco::GeometryMetadata ignored;
  if ((data[10] & 0x80) && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored))
    document.fail(where, "corrupt Draco metadata");
  std::uint8_t traversal = 0;
  if (data[8] == draco::MESH_EDGEBREAKER_ENCODING) buffer.Decode(&traversal);
  std::uint32_t counts[2] = {
      0, 0};  // faces and points, or vertices and faces: either way their sum bounds the memory
  if (!draco::DecodeVarint(&counts[0], &buffer) || !draco::DecodeVarint(&counts[1], &buffer))
    document.fail(where, "the Draco data is cut off");
  document.budget.charge(std::uint64_t(counts[0]) + counts[1], 32, where);
}

/// Attribute values of all points, as floats, or as whole numbers for joints.
AccessorView attributeView(GltfDocument& document, const draco::PointCloud& mesh,
                           const draco::PointAttribute& attribute, const gloam_tinygltf::Accessor& accessor,
                           int components, bool whole, std::deque<Bytes>& storage, const std::string& where) {
  if (attribute.num_components() != components)
    document.fail(where, fmt::format("{} components in the Draco data, {} in the accessor",
                                     int(attribute.num_components()), components));
  const std::size_t points = mesh.num_points(),
                    element = sizeof(float) * static_cast<std::size_t>(components);
  document.budget.charge(points, element, where);
  Bytes& bytes = storage.emplace_back(points * element);
  float scale = 1.0f;  // normalised integers, where Draco was not told that they are
  if (accessor.normalized && !attribute.normalized()) switch (attribute.data_type()) {
      case draco::DT_INT8:
        scale = 1.0f / 127.0f;
        break;
      case draco::DT_UINT8:
        scale = 1.0f / 255.0f;
        break;
      case draco::DT_INT16:
        scale = 1.0f / 32767.0f;
        break;
      case draco::DT_UINT16:
        scale = 1.0f / 65535.0f;
        break;
      default:
        break;
    }
  for (std::size_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex at =
        attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    float values[16] = {};
    std::uint32_t integers[16] = {};
    const bool good = at.value() < attribute.size() &&
                      (whole ? attribute.ConvertValue(at, static_cast<std::int8_t>(components), integers)
                             : attribute.ConvertValue(at, static_cast<std::int8_t>(components), values));
    if (!good) document.fail(where, fmt::format("corrupt Draco data at point {}", i));
    for (float& value : values) value *= scale;
    std::memcpy(&bytes[i * element], whole ? static_cast<const void*>(integers) : values, element);
  }
  AccessorView view;
  view.data = bytes.data();
  view.stride = element;
  view.count = points;
  view.component_type = whole ? 5125 : 5126;
  view.components = components;
  return view;
}

}  // namespace

void checkMeshoptView(const GltfDocument& document, const Json& view, const Json& meshopt,
                      const std::string& where) {
  const std::string at = where + ".extensions.EXT_meshopt_compression";
  const std::uint64_t stride = meshopt["byteStride"], count = meshopt["count"], length = view["byteLength"];
  const std::string mode = meshopt["mode"], filter = meshopt.value("filter", "NONE");
  if (count * stride != length)
    document.fail(at + ".count",
                  fmt::format("{} elements of {} bytes, but byteLength is {}", count, stride, length));
  if (view.contains("byteStride") && view["byteStride"] != stride)
    document.fail(at + ".byteStride",
                  fmt::format("{}, but {} in the buffer view", stride, view["byteStride"].get<int>()));
  const auto require = [&](bool good, const char* expected) {
    if (!good)
      document.fail(at + ".byteStride",
                    fmt::format("{} was expected for {} {}, found {}", expected, mode, filter, stride));
  };
  if (mode == "ATTRIBUTES") {
    require(stride % 4 == 0, "a multiple of 4");
    if (filter == "OCTAHEDRAL") require(stride == 4 || stride == 8, "4 or 8");
    if (filter == "QUATERNION") require(stride == 8, "8");
    return;
  }
  require(stride == 2 || stride == 4, "2 or 4");
  if (filter != "NONE") document.fail(at + ".filter", "NONE was expected for " + mode + ", found " + filter);
  if (mode == "TRIANGLES" && count % 3 != 0) document.fail(at + ".count", "a multiple of 3 was expected");
}

Bytes decodeMeshopt(GltfDocument& document, ByteSpan compressed, const Json& meshopt,
                    const std::string& where) {
  const std::size_t stride = meshopt["byteStride"], count = meshopt["count"];
  const std::string mode = meshopt["mode"], filter = meshopt.value("filter", "NONE");
  document.budget.charge(count, stride, where + ".extensions.EXT_meshopt_compression.count");
  Bytes out(count * stride);
  int result = 0;
  if (mode == "ATTRIBUTES")
    result = meshopt_decodeVertexBuffer(out.data(), count, stride, compressed.data(), compressed.size());
  else if (mode == "TRIANGLES")
    result = meshopt_decodeIndexBuffer(out.data(), count, stride, compressed.data(), compressed.size());
  else
    result = meshopt_decodeIndexSequence(out.data(), count, stride, compressed.data(), compressed.size());
  if (result != 0)
    document.fail(where, fmt::format("corrupt EXT_meshopt_compression data (decoder says {})", result));
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  return out;
}

DracoPrimitive decodeDraco(GltfDocument& document, const gloam_tinygltf::Primitive& primitive,
                           const Json& draco, const std::string& where) {
  const std::string at = where + ".extensions.KHR_draco_mesh_compression";
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
    document.fail(where + ".mode", "triangles were expected with Draco");
  const ByteSpan data = document.view(draco["bufferView"]);
  chargeDracoCounts(document, data, at);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) document.fail(at, "corrupt data: " + oneLine(decoded.status().error_msg_string()));
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

  DracoPrimitive out;
  document.budget.charge(mesh->num_faces(), 3 * sizeof(std::uint32_t), at);
  out.indices.reserve(std::size_t(mesh->num_faces()) * 3);
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
    for (int corner = 0; corner < 3; ++corner) out.indices.push_back(mesh->face(face)[corner].value());

  for (const auto& [name, id] : draco["attributes"].items()) {
    const auto known = primitive.attributes.find(name);
    if (known == primitive.attributes.end()) continue;
    const std::string field = at + ".attributes." + oneLine(name);
    const draco::PointAttribute* attribute =
        id > Json(0xffffffffu) ? nullptr : mesh->GetAttributeByUniqueId(id.get<std::uint32_t>());
    if (!attribute)
      document.fail(field, fmt::format("there is no attribute {} in the data", id.get<std::uint64_t>()));
    const auto index = static_cast<std::size_t>(known->second);
    const int components = componentsOf(document.json["accessors"][index]["type"]);
    out.attributes[name] = attributeView(document, *mesh, *attribute, document.model.accessors[index],
                                         components, name.starts_with("JOINTS"), out.storage, field);
  }
  return out;
}

}  // namespace gloam
