// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_neighbourhood.h"

#include <fmt/format.h>
#include <gloam/sh.h>

#include "scene/gltf_extension_reader.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 2, kMostPoints = 4096;  // a side

}  // namespace

Json neighbourhoodJson(const NeighbourhoodTransfer& transfer, bool half_float, GlbBuilder& builder) {
  Json json = {{"version", kVersion},
               {"lightOrder", transfer.light_order},
               {"fieldOrder", transfer.field_order},
               {"bounces", transfer.indirect.empty() ? 0 : transfer.bounces},
               {"format", half_float ? "half" : "float"},
               {"size", {transfer.size.x, transfer.size.y, transfer.size.z}},
               {"centre", tidyArray(transfer.centre, 3)},
               {"spacing", tidyArray(transfer.spacing, 3)},
               {"core", tidyArray(transfer.core, 3)},
               {"growth", tidyArray(transfer.growth, 3)},
               {"visibility", builder.addNumbers(transfer.visibility, half_float)}};
  if (!transfer.indirect.empty()) json["indirect"] = builder.addNumbers(transfer.indirect, half_float);
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
  const ExtensionReader reader(accessors, extension, where);
  const int version = reader.integer("version", 1, 0x7fffffff);
  if (version > kVersion)
    reader.fail("version", fmt::format("{} is not known; 1 to {} are read", version, kVersion));
  auto transfer = std::make_shared<NeighbourhoodTransfer>();
  transfer->field_order = reader.integer("fieldOrder", 1, sh::kMaxOrder);
  transfer->light_order = reader.integer("lightOrder", 1, transfer->field_order);
  transfer->bounces = reader.integer("bounces", 0, 1000000);
  const bool half_float = reader.halfFloat();
  transfer->size = reader.integers("size", 2, kMostPoints);
  transfer->spacing = reader.vector("spacing", 1e-12);
  if (version == 1) {  // even all over
    transfer->core = 0.5f * transfer->spacing * glm::vec3(transfer->size - 1);
    transfer->centre = reader.vector("firstPoint") + transfer->core;
    transfer->growth = transfer->spacing;
  } else {
    transfer->centre = reader.vector("centre");
    transfer->core = reader.vector("core", 0.0);
    transfer->growth = reader.vector("growth", 1e-12);
  }
  const std::size_t points = transfer->points();
  transfer->visibility = reader.numbers("visibility", points * transfer->visibilityCount(), half_float);
  if (transfer->bounces > 0) {
    transfer->indirect = reader.numbers("indirect", 3 * points * transfer->matrixCount(), half_float);
  } else if (reader.has("indirect")) {
    reader.fail("indirect", "there are no bounces");
  }
  if (!glm::all(glm::lessThan(glm::abs(transfer->half()), glm::vec3(1e18f))))
    reader.fail("growth", "points lie beyond 1e18");
  return transfer;
}

}  // namespace gloam
