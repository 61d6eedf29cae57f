// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_transfer.h"

#include <fmt/format.h>
#include <gloam/sh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/gltf_extension_reader.h"
#include "scene/gltf_transfer_pca.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

// 2: points may be texels. Written only where they are, so that older readers take the rest.
// 3: diffuse transfer may be compressed.
constexpr int kVersion = 1, kVersionOfTexels = 2, kVersionOfPca = 3;
constexpr const char *kUnshadowed = "unshadowed", *kShadowed = "shadowed",
                     *kInterreflected = "interreflected";

std::uint32_t crc32(std::uint32_t crc, const void* data, std::size_t size) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      t[i] = i;
      for (int bit = 0; bit < 8; ++bit) t[i] = t[i] & 1u ? 0xEDB88320u ^ (t[i] >> 1) : t[i] >> 1;
    }
    return t;
  }();
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  for (std::size_t i = 0; i < size; ++i) crc = table[(crc ^ bytes[i]) & 0xFFu] ^ (crc >> 8);
  return crc;
}

}  // namespace

std::string geometryChecksum(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  static_assert(sizeof(glm::vec3) == 12);
  std::uint32_t crc = 0xFFFFFFFFu;
  crc = crc32(crc, positions.data(), positions.size_bytes());
  crc = crc32(crc, indices.data(), indices.size_bytes());
  return fmt::format("{:08x}", crc ^ 0xFFFFFFFFu);
}

std::string texCoordChecksum(std::span<const glm::vec2> uvs) {
  static_assert(sizeof(glm::vec2) == 8);
  return fmt::format("{:08x}", crc32(0xFFFFFFFFu, uvs.data(), uvs.size_bytes()) ^ 0xFFFFFFFFu);
}

const char* transferKind(const Transfer& transfer) {
  if (transfer.bounces > 0) return kInterreflected;
  return transfer.directions > 0 ? kShadowed : kUnshadowed;
}

Json transferJson(const Transfer& transfer, const Mesh& mesh, bool half_float, GlbBuilder& builder) {
  Json json = {{"version", transfer.ofTexels() ? kVersionOfTexels : kVersion},
               {"kind", transferKind(transfer)},
               {"order", transfer.order},
               {"bounces", transfer.indirect.empty() ? 0 : transfer.bounces},
               {"directions", transfer.directions},
               {"format", half_float ? "half" : "float"},
               {"geometry", geometryChecksum(mesh.positions, mesh.indices)}};
  if (transfer.object > 0) json["object"] = transfer.object;
  if (transfer.compressed) {
    json["version"] = kVersionOfPca;
    json["pca"] = pcaJson(*transfer.compressed, half_float, builder);
  } else {
    json["direct"] = builder.addNumbers(transfer.direct, half_float);
    if (!transfer.indirect.empty()) json["indirect"] = builder.addNumbers(transfer.indirect, half_float);
  }
  if (transfer.ofTexels()) {
    json["texels"] = {{"width", transfer.texel_width},
                      {"height", transfer.texel_height},
                      {"texCoord", transfer.uv_set},
                      {"uvs", texCoordChecksum(mesh.uv_sets[std::size_t(transfer.uv_set)])}};
  }
  const GlossyTransfer& glossy = transfer.glossy;
  if (glossy.empty()) return json;
  json["glossy"] = {{"lightOrder", glossy.light_order},
                    {"fieldOrder", glossy.field_order},
                    {"visibility", builder.addNumbers(glossy.visibility, half_float)}};
  if (!glossy.indirect.empty()) json["glossy"]["indirect"] = builder.addNumbers(glossy.indirect, half_float);
  if (glossy.exponent > 0.0f) json["glossy"]["exponent"] = tidy(glossy.exponent);
  return json;
}

static GlossyTransfer readGlossy(GltfAccessors& accessors, const Json& json, const std::string& where,
                                 std::size_t vertices, bool half_float, bool has_bounces) {
  const ExtensionReader reader(accessors, json, where);
  GlossyTransfer glossy;
  glossy.field_order = reader.integer("fieldOrder", 1, sh::kMaxOrder);
  glossy.light_order = reader.integer("lightOrder", 1, glossy.field_order);
  if (reader.has("exponent")) glossy.exponent = reader.number("exponent", 1.0f, 1.0e6f);
  glossy.visibility = reader.numbers("visibility", vertices * glossy.visibilityCount(), half_float);
  if (has_bounces) {
    glossy.indirect = reader.numbers("indirect", 3 * vertices * glossy.matrixCount(), half_float);
  } else if (reader.has("indirect")) {
    reader.fail("indirect", "there are no bounces");
  }
  return glossy;
}

/// Where transfer is that of a lightmap.
static void readTexels(GltfAccessors& accessors, const Json& json, const std::string& where,
                       const UvSet& uvSet, Transfer& transfer) {
  constexpr int kMostTexels = 65536;
  const ExtensionReader reader(accessors, json, where);
  transfer.texel_width = reader.integer("width", 1, kMostTexels);
  transfer.texel_height = reader.integer("height", 1, kMostTexels);
  transfer.uv_set = reader.integer("texCoord", 0, 7);
  const std::optional<std::vector<glm::vec2>> uvs = uvSet(transfer.uv_set);
  if (!uvs) reader.fail("texCoord", fmt::format("the primitive has no TEXCOORD_{}", transfer.uv_set));
  const std::string checksum = texCoordChecksum(*uvs);
  if (reader.word("uvs") != checksum) {
    reader.fail("uvs",
                fmt::format("the transfer belongs to other texture coordinates (the checksum of these is {})",
                            checksum));
  }
}

std::shared_ptr<const Transfer> readTransfer(GltfAccessors& accessors, const Json& extension,
                                             std::span<const glm::vec3> positions,
                                             std::span<const std::uint32_t> indices, const UvSet& uvSet,
                                             const std::string& where) {
  const ExtensionReader reader(accessors, extension, where);
  const int version = reader.integer("version", 1, 0x7fffffff);
  if (version > kVersionOfPca)
    reader.fail("version",
                fmt::format("{} is not known; {} to {} are read", version, kVersion, kVersionOfPca));
  auto transfer = std::make_shared<Transfer>();
  transfer->order = reader.integer("order", 1, sh::kMaxOrder);
  transfer->bounces = reader.integer("bounces", 0, 1000000);
  transfer->directions = reader.integer("directions", 0, 0x7fffffff);
  if (reader.has("object")) transfer->object = reader.integer("object", 0, 0x7fffffff);
  // For information, and so taken as far as it is understood: transfer that was sampled along no direction is unshadowed.
  const Json kind = extension.value("kind", Json());
  if (kind == kUnshadowed && transfer->bounces == 0) transfer->directions = 0;
  if (kind == kShadowed) transfer->directions = std::max(transfer->directions, 1);
  const bool half_float = reader.halfFloat();
  const std::string checksum = geometryChecksum(positions, indices);
  if (reader.word("geometry") != checksum) {
    reader.fail("geometry",
                fmt::format("the transfer belongs to another mesh (this one's checksum is {})", checksum));
  }
  if (version >= kVersionOfTexels && reader.has("texels"))
    readTexels(accessors, extension.at("texels"), where + ".texels", uvSet, *transfer);
  const std::size_t points = transfer->ofTexels()
                                 ? std::size_t(transfer->texel_width) * std::size_t(transfer->texel_height)
                                 : positions.size();
  const std::size_t count = points * std::size_t(transfer->order * transfer->order);
  if (version >= kVersionOfPca && reader.has("pca")) {
    readPca(accessors, extension.at("pca"), where + ".pca", points, half_float, *transfer);
  } else {
    transfer->direct = reader.numbers("direct", count, half_float);
    if (transfer->bounces > 0) {
      transfer->indirect = reader.numbers("indirect", 3 * count, half_float);
    } else if (reader.has("indirect")) {
      reader.fail("indirect", "there are no bounces");
    }
  }
  if (reader.has("glossy")) {
    transfer->glossy = readGlossy(accessors, extension.at("glossy"), where + ".glossy", positions.size(),
                                  half_float, transfer->bounces > 0);
  }
  return transfer;
}

std::shared_ptr<const Transfer> transferOfVertices(const Transfer& transfer,
                                                   std::span<const std::uint32_t> vertices) {
  auto picked = std::make_shared<Transfer>();
  picked->order = transfer.order;
  picked->bounces = transfer.bounces;
  picked->directions = transfer.directions;
  picked->object = transfer.object;
  if (transfer.compressed && transfer.ofTexels()) {
    picked->compressed = transfer.compressed;
  } else if (transfer.compressed) {
    picked->compressed = pcaOfPoints(*transfer.compressed, vertices);
  }
  const auto pick = [&](const std::vector<float>& from, std::size_t stride, std::vector<float>& to) {
    if (from.empty()) return;
    to.reserve(vertices.size() * stride);
    for (const std::uint32_t v : vertices) {
      const auto begin = from.begin() + std::ptrdiff_t(v * stride);
      to.insert(to.end(), begin, begin + std::ptrdiff_t(stride));
    }
  };
  const std::size_t coefficients = std::size_t(transfer.order * transfer.order);
  if (transfer.ofTexels()) {
    picked->texel_width = transfer.texel_width;
    picked->texel_height = transfer.texel_height;
    picked->uv_set = transfer.uv_set;
    picked->direct = transfer.direct;
    picked->indirect = transfer.indirect;
  } else {
    pick(transfer.direct, coefficients, picked->direct);
    pick(transfer.indirect, 3 * coefficients, picked->indirect);
  }
  const GlossyTransfer& glossy = transfer.glossy;
  picked->glossy.light_order = glossy.light_order;
  picked->glossy.field_order = glossy.field_order;
  picked->glossy.exponent = glossy.exponent;
  pick(glossy.visibility, glossy.visibilityCount(), picked->glossy.visibility);
  pick(glossy.indirect, 3 * glossy.matrixCount(), picked->glossy.indirect);
  return picked;
}

}  // namespace gloam
