// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_volume.h"

#include <gloam/sh.h>

#include <cmath>
#include <limits>

#include "scene/gltf_extension_reader.h"
#include "scene/volume_places.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1, kMostVoxels = 65536;             // a side
constexpr double kAny = std::numeric_limits<double>::max();  // checkVolume says what is too much

Json transferJson(const Transfer& transfer, bool half_float, GlbBuilder& builder) {
  Json json = {{"order", transfer.order},
               {"bounces", transfer.indirect.empty() ? 0 : transfer.bounces},
               {"directions", transfer.directions},
               {"direct", builder.addNumbers(transfer.direct, half_float)}};
  if (!transfer.indirect.empty()) json["indirect"] = builder.addNumbers(transfer.indirect, half_float);
  return json;
}

Json volumeJson(const Volume& volume, bool half_float, GlbBuilder& builder) {
  Json json = {{"version", kVersion},
               {"format", half_float ? "half" : "float"},
               {"size", {volume.size.x, volume.size.y, volume.size.z}},
               {"boundsMin", tidyArray(volume.bounds_min, 3)},
               {"boundsMax", tidyArray(volume.bounds_max, 3)},
               {"albedo", tidyArray(volume.albedo, 3)},
               {"asymmetry", tidy(volume.asymmetry)},
               {"density", builder.addNumbers(volume.density, half_float)}};
  if (!volume.name.empty()) json["name"] = volume.name;
  if (volume.transfer) json["transfer"] = transferJson(*volume.transfer, half_float, builder);
  return json;
}

std::shared_ptr<const Transfer> readTransfer(GltfAccessors& accessors, const Json& json,
                                             const std::string& where, std::size_t voxels, bool half_float) {
  const ExtensionReader reader(accessors, json, where);
  auto transfer = std::make_shared<Transfer>();
  transfer->order = reader.integer("order", 1, sh::kMaxOrder);
  transfer->bounces = reader.integer("bounces", 0, 1000000);
  transfer->directions = reader.integer("directions", 0, 0x7fffffff);
  const std::size_t count = voxels * std::size_t(transfer->order * transfer->order);
  transfer->direct = reader.numbers("direct", count, half_float);
  if (transfer->bounces > 0) {
    transfer->indirect = reader.numbers("indirect", 3 * count, half_float);
  } else if (reader.has("indirect")) {
    reader.fail("indirect", "there are no bounces");
  }
  return transfer;
}

}  // namespace

void writeVolumes(const Scene& scene, bool half_float, GlbBuilder& builder) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (!scene.nodes[n].volume) continue;
    builder.root["nodes"][n]["extensions"][kVolumeExtension] =
        volumeJson(*scene.nodes[n].volume, half_float, builder);
    builder.use(kVolumeExtension);
  }
}

std::shared_ptr<const Volume> readVolume(GltfAccessors& accessors, const Json& extension,
                                         const std::string& where) {
  const ExtensionReader reader(accessors, extension, where);
  GltfDocument& document = accessors.document();
  const int version = reader.integer("version", 1, 0x7fffffff);
  if (version != kVersion)
    reader.fail("version", fmt::format("{} is not known; {} is read", version, kVersion));
  const bool half_float = reader.halfFloat();
  auto volume = std::make_shared<Volume>();
  if (reader.has("name")) volume->name = reader.word("name");
  const glm::vec3 size = reader.vector("size", -kAny, kAny);
  for (int c = 0; c < 3; ++c) {
    if (!(size[c] >= 2.0f && size[c] <= float(kMostVoxels)) || size[c] != std::floor(size[c]))
      reader.fail("size", fmt::format("{} is not a whole number from 2 to {}", size[c], kMostVoxels));
    volume->size[c] = int(size[c]);
  }
  volume->bounds_min = reader.vector("boundsMin", -kAny, kAny);
  volume->bounds_max = reader.vector("boundsMax", -kAny, kAny);
  volume->albedo = reader.vector("albedo", -kAny, kAny);
  volume->asymmetry = reader.number("asymmetry", -1.0f, 1.0f);
  volume->density =
      reader.numbers("density", volume->voxels(), half_float, std::numeric_limits<float>::max());
  try {
    checkVolume(*volume, where);
  } catch (const Error& error) {
    throw Error(document.place(), error.what());
  }
  if (reader.has("transfer"))
    volume->transfer =
        readTransfer(accessors, extension["transfer"], where + ".transfer", volume->voxels(), half_float);
  return volume;
}

}  // namespace gloam
