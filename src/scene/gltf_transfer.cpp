// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_transfer.h"

#include <fmt/format.h>
#include <gloam/sh.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/half_float.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr const char *kUnshadowed = "unshadowed", *kShadowed = "shadowed",
                     *kInterreflected = "interreflected";
constexpr int kUnsignedShort = 5123, kFloat = 5126;

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

int addNumbers(const std::vector<float>& values, bool half_float, GlbBuilder& builder) {
  if (!half_float) return builder.addFloats(values, 1, GlbBuilder::Target::kNone);
  std::vector<std::uint16_t> halves;
  halves.reserve(values.size());
  for (const float value : values) halves.push_back(halfFromFloat(value));
  return builder.addShorts(halves, 1, GlbBuilder::Target::kNone);
}

/// Members of the extension's object, each checked as it is taken.
class TransferReader {
 public:
  TransferReader(GltfAccessors& accessors, const Json& json, const std::string& where)
      : accessors_(accessors), document_(accessors.document()), json_(json), where_(where) {
    if (!json.is_object()) document_.fail(where, "an object was expected");
  }

  int integer(const char* name, int least, int most) const {
    const auto found = json_.find(name);
    if (found == json_.end()) fail(name, "missing");
    if (!found->is_number_integer() || *found < least || *found > most) {
      fail(name, fmt::format("{} is not a whole number from {} to {}", shortText(*found), least, most));
    }
    return found->get<int>();
  }

  std::string word(const char* name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) fail(name, "missing");
    if (!found->is_string()) fail(name, fmt::format("{} is not a string", shortText(*found)));
    return found->get<std::string>();
  }

  float number(const char* name, float least, float most) const {
    const Json& value = json_.at(name);
    if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= most)) {
      fail(name, fmt::format("{} is not a number from {} to {}", shortText(value), least, most));
    }
    return value.get<float>();
  }

  bool has(const char* name) const { return json_.contains(name); }

  std::vector<float> numbers(const char* name, std::size_t count, bool half_float) const {
    const std::size_t accessors = document_.array("accessors").size();
    if (accessors == 0) fail(name, "the file has no accessors");
    const int index = integer(name, 0, int(std::min<std::size_t>(accessors, 0x7fffffffu)) - 1);
    const AccessorView view = accessors_.view(index);
    const int type = half_float ? kUnsignedShort : kFloat;
    if (view.component_type != type || view.components != 1 || view.normalized) {
      fail(name, fmt::format("accessors[{}] must be SCALAR of component type {}", index, type));
    }
    if (view.count != count) {
      fail(name, fmt::format("accessors[{}] has {} elements, {} were expected", index, view.count, count));
    }
    document_.budget.charge(count, sizeof(float), where_ + "." + name);
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = half_float ? floatFromHalf(std::uint16_t(view.integer(i, 0))) : view.number(i, 0);
      if (!std::isfinite(values[i]))
        fail(name, fmt::format("element {} of accessors[{}] is not finite", i, index));
    }
    return values;
  }

  [[noreturn]] void fail(const char* name, const std::string& message) const {
    document_.fail(where_ + "." + name, message);
  }

 private:
  static std::string shortText(const Json& value) {
    return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40);
  }

  GltfAccessors& accessors_;
  GltfDocument& document_;
  const Json& json_;
  const std::string& where_;
};

}  // namespace

std::string geometryChecksum(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  static_assert(sizeof(glm::vec3) == 12);
  std::uint32_t crc = 0xFFFFFFFFu;
  crc = crc32(crc, positions.data(), positions.size_bytes());
  crc = crc32(crc, indices.data(), indices.size_bytes());
  return fmt::format("{:08x}", crc ^ 0xFFFFFFFFu);
}

const char* transferKind(const Transfer& transfer) {
  if (transfer.bounces > 0) return kInterreflected;
  return transfer.directions > 0 ? kShadowed : kUnshadowed;
}

Json transferJson(const Transfer& transfer, const Mesh& mesh, bool half_float, GlbBuilder& builder) {
  Json json = {{"version", kVersion},
               {"kind", transferKind(transfer)},
               {"order", transfer.order},
               {"bounces", transfer.indirect.empty() ? 0 : transfer.bounces},
               {"directions", transfer.directions},
               {"format", half_float ? "half" : "float"},
               {"geometry", geometryChecksum(mesh.positions, mesh.indices)},
               {"direct", addNumbers(transfer.direct, half_float, builder)}};
  if (!transfer.indirect.empty()) json["indirect"] = addNumbers(transfer.indirect, half_float, builder);
  const GlossyTransfer& glossy = transfer.glossy;
  if (glossy.empty()) return json;
  json["glossy"] = {{"lightOrder", glossy.light_order},
                    {"fieldOrder", glossy.field_order},
                    {"visibility", addNumbers(glossy.visibility, half_float, builder)}};
  if (!glossy.indirect.empty()) json["glossy"]["indirect"] = addNumbers(glossy.indirect, half_float, builder);
  if (glossy.exponent > 0.0f) json["glossy"]["exponent"] = tidy(glossy.exponent);
  return json;
}

static GlossyTransfer readGlossy(GltfAccessors& accessors, const Json& json, const std::string& where,
                                 std::size_t vertices, bool half_float, bool has_bounces) {
  const TransferReader reader(accessors, json, where);
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

std::shared_ptr<const Transfer> readTransfer(GltfAccessors& accessors, const Json& extension,
                                             std::span<const glm::vec3> positions,
                                             std::span<const std::uint32_t> indices,
                                             const std::string& where) {
  const TransferReader reader(accessors, extension, where);
  const int version = reader.integer("version", 1, 0x7fffffff);
  if (version != kVersion)
    reader.fail("version", fmt::format("{} is not known; {} is read", version, kVersion));
  auto transfer = std::make_shared<Transfer>();
  transfer->order = reader.integer("order", 1, sh::kMaxOrder);
  transfer->bounces = reader.integer("bounces", 0, 1000000);
  transfer->directions = reader.integer("directions", 0, 0x7fffffff);
  // For information, and so taken as far as it is understood: transfer that was sampled along no direction is unshadowed.
  const Json kind = extension.value("kind", Json());
  if (kind == kUnshadowed && transfer->bounces == 0) transfer->directions = 0;
  if (kind == kShadowed) transfer->directions = std::max(transfer->directions, 1);
  const std::string format = reader.word("format");
  if (format != "float" && format != "half") {
    reader.fail("format", "neither \"float\" nor \"half\"");
  }
  const std::string checksum = geometryChecksum(positions, indices);
  if (reader.word("geometry") != checksum) {
    reader.fail("geometry",
                fmt::format("the transfer belongs to another mesh (this one's checksum is {})", checksum));
  }
  const std::size_t count = positions.size() * std::size_t(transfer->order * transfer->order);
  transfer->direct = reader.numbers("direct", count, format == "half");
  if (transfer->bounces > 0) {
    transfer->indirect = reader.numbers("indirect", 3 * count, format == "half");
  } else if (reader.has("indirect")) {
    reader.fail("indirect", "there are no bounces");
  }
  if (reader.has("glossy")) {
    transfer->glossy = readGlossy(accessors, extension.at("glossy"), where + ".glossy", positions.size(),
                                  format == "half", transfer->bounces > 0);
  }
  return transfer;
}

std::shared_ptr<const Transfer> transferOfVertices(const Transfer& transfer,
                                                   std::span<const std::uint32_t> vertices) {
  auto picked = std::make_shared<Transfer>();
  picked->order = transfer.order;
  picked->bounces = transfer.bounces;
  picked->directions = transfer.directions;
  const auto pick = [&](const std::vector<float>& from, std::size_t stride, std::vector<float>& to) {
    if (from.empty()) return;
    to.reserve(vertices.size() * stride);
    for (const std::uint32_t v : vertices) {
      const auto begin = from.begin() + std::ptrdiff_t(v * stride);
      to.insert(to.end(), begin, begin + std::ptrdiff_t(stride));
    }
  };
  const std::size_t coefficients = std::size_t(transfer.order * transfer.order);
  pick(transfer.direct, coefficients, picked->direct);
  pick(transfer.indirect, 3 * coefficients, picked->indirect);
  const GlossyTransfer& glossy = transfer.glossy;
  picked->glossy.light_order = glossy.light_order;
  picked->glossy.field_order = glossy.field_order;
  picked->glossy.exponent = glossy.exponent;
  pick(glossy.visibility, glossy.visibilityCount(), picked->glossy.visibility);
  pick(glossy.indirect, 3 * glossy.matrixCount(), picked->glossy.indirect);
  return picked;
}

}  // namespace gloam
