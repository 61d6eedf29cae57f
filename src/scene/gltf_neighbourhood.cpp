// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_neighbourhood.h"

#include <fmt/format.h>
#include <gloam/sh.h>

#include <algorithm>
#include <cmath>

#include "scene/half_float.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1, kMostPoints = 4096;  // a side
constexpr int kUnsignedShort = 5123, kFloat = 5126;

int addNumbers(const std::vector<float>& values, bool half_float, GlbBuilder& builder) {
  if (!half_float) return builder.addFloats(values, 1, GlbBuilder::Target::kNone);
  std::vector<std::uint16_t> halves(values.size());
  std::transform(values.begin(), values.end(), halves.begin(), halfFromFloat);
  return builder.addShorts(halves, 1, GlbBuilder::Target::kNone);
}

/// Members of the extension's object, each checked as it is taken.
class Reader {
 public:
  Reader(GltfAccessors& accessors, const Json& json, const std::string& where)
      : accessors_(accessors), document_(accessors.document()), json_(json), where_(where) {
    if (!json.is_object()) document_.fail(where, "an object was expected");
  }

  bool has(const char* name) const { return json_.contains(name); }

  int integer(const char* name, int least, int most) const { return whole(member(name), name, least, most); }

  glm::ivec3 integers(const char* name, int least, int most) const {
    const Json& array = triple(name);
    return {whole(array[0], name, least, most), whole(array[1], name, least, most),
            whole(array[2], name, least, most)};
  }

  glm::vec3 numbers(const char* name, double least) const {
    const Json& array = triple(name);
    glm::vec3 v;
    for (int c = 0; c < 3; ++c) {
      const Json& value = array[std::size_t(c)];
      if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= 1e12))
        fail(name, fmt::format("{} is not a number from {} to 1e12", text(value), least));
      v[c] = value.get<float>();
    }
    return v;
  }

  bool halfFloat() const {
    const Json& format = member("format");
    if (format != "float" && format != "half") fail("format", "neither \"float\" nor \"half\"");
    return format == "half";
  }

  std::vector<float> values(const char* name, std::size_t count, bool half_float) const {
    const std::size_t accessors = document_.array("accessors").size();
    if (accessors == 0) fail(name, "the file has no accessors");
    const int index = integer(name, 0, int(std::min<std::size_t>(accessors, 0x7fffffffu)) - 1);
    const AccessorView view = accessors_.view(index);
    const int type = half_float ? kUnsignedShort : kFloat;
    if (view.component_type != type || view.components != 1 || view.normalized)
      fail(name, fmt::format("accessors[{}] must be SCALAR of component type {}", index, type));
    if (view.count != count)
      fail(name, fmt::format("accessors[{}] has {} elements, {} were expected", index, view.count, count));
    document_.budget.charge(count, sizeof(float), where_ + "." + name);
    std::vector<float> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
      numbers[i] = half_float ? floatFromHalf(std::uint16_t(view.integer(i, 0))) : view.number(i, 0);
      if (!std::isfinite(numbers[i]))
        fail(name, fmt::format("element {} of accessors[{}] is not finite", i, index));
    }
    return numbers;
  }

  [[noreturn]] void fail(const char* name, const std::string& message) const {
    document_.fail(where_ + "." + name, message);
  }

 private:
  const Json& member(const char* name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) fail(name, "missing");
    return *found;
  }
  const Json& triple(const char* name) const {
    const Json& array = member(name);
    if (!array.is_array() || array.size() != 3) fail(name, "three numbers were expected");
    return array;
  }
  int whole(const Json& value, const char* name, int least, int most) const {
    if (!value.is_number_integer() || value < least || value > most)
      fail(name, fmt::format("{} is not a whole number from {} to {}", text(value), least, most));
    return value.get<int>();
  }
  static std::string text(const Json& value) {
    return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40);
  }

  GltfAccessors& accessors_;
  GltfDocument& document_;
  const Json& json_;
  const std::string& where_;
};

}  // namespace

Json neighbourhoodJson(const NeighbourhoodTransfer& transfer, bool half_float, GlbBuilder& builder) {
  Json json = {{"version", kVersion},
               {"lightOrder", transfer.light_order},
               {"fieldOrder", transfer.field_order},
               {"bounces", transfer.indirect.empty() ? 0 : transfer.bounces},
               {"format", half_float ? "half" : "float"},
               {"size", {transfer.size.x, transfer.size.y, transfer.size.z}},
               {"firstPoint", tidyArray(transfer.first_point, 3)},
               {"spacing", tidyArray(transfer.spacing, 3)},
               {"visibility", addNumbers(transfer.visibility, half_float, builder)}};
  if (!transfer.indirect.empty()) json["indirect"] = addNumbers(transfer.indirect, half_float, builder);
  return json;
}

void writeNeighbourhoods(const Scene& scene, bool half_float, GlbBuilder& builder) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (!scene.nodes[n].neighbourhood) continue;
    builder.root["nodes"][n]["extensions"][kNeighbourhoodExtension] =
        neighbourhoodJson(*scene.nodes[n].neighbourhood, half_float, builder);
    builder.use(kNeighbourhoodExtension);
  }
}

std::shared_ptr<const NeighbourhoodTransfer> readNeighbourhood(GltfAccessors& accessors,
                                                               const Json& extension,
                                                               const std::string& where) {
  const Reader reader(accessors, extension, where);
  const int version = reader.integer("version", 1, 0x7fffffff);
  if (version != kVersion)
    reader.fail("version", fmt::format("{} is not known; {} is read", version, kVersion));
  auto transfer = std::make_shared<NeighbourhoodTransfer>();
  transfer->field_order = reader.integer("fieldOrder", 1, sh::kMaxOrder);
  transfer->light_order = reader.integer("lightOrder", 1, transfer->field_order);
  transfer->bounces = reader.integer("bounces", 0, 1000000);
  const bool half_float = reader.halfFloat();
  transfer->size = reader.integers("size", 2, kMostPoints);
  transfer->first_point = reader.numbers("firstPoint", -1e12);
  transfer->spacing = reader.numbers("spacing", 1e-12);
  const std::size_t points = transfer->points();
  transfer->visibility = reader.values("visibility", points * transfer->visibilityCount(), half_float);
  if (transfer->bounces > 0) {
    transfer->indirect = reader.values("indirect", 3 * points * transfer->matrixCount(), half_float);
  } else if (reader.has("indirect")) {
    reader.fail("indirect", "there are no bounces");
  }
  return transfer;
}

}  // namespace gloam
