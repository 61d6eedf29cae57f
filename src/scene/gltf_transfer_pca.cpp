// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_transfer_pca.h"

#include "scene/gltf_extension_reader.h"

namespace gloam {

nlohmann::json pcaJson(const CompressedTransfer& compressed, bool half_float, GlbBuilder& builder) {
  nlohmann::json json = {{"clusters", compressed.clusters},
                         {"vectors", compressed.vectors},
                         {"means", builder.addNumbers(compressed.means, half_float)}};
  if (compressed.vectors > 0) {
    json["basis"] = builder.addNumbers(compressed.basis, half_float);
    json["weights"] = builder.addNumbers(compressed.weights, half_float);
  }
  if (compressed.clusters <= 256) {
    const std::vector<std::uint8_t> bytes(compressed.cluster.begin(), compressed.cluster.end());
    json["cluster"] = builder.addBytes(bytes, 1, GlbBuilder::Target::kNone);
  } else {
    json["cluster"] = builder.addShorts(compressed.cluster, 1, GlbBuilder::Target::kNone);
  }
  return json;
}

void readPca(GltfAccessors& accessors, const nlohmann::json& json, const std::string& where,
             std::size_t points, bool half_float, Transfer& transfer) {
  const ExtensionReader reader(accessors, json, where);
  auto compressed = std::make_shared<CompressedTransfer>();
  const auto direct = std::size_t(transfer.order * transfer.order);
  const std::size_t width = transfer.bounces > 0 ? 4 * direct : direct;
  compressed->clusters = reader.integer("clusters", 1, 65536);
  compressed->vectors = reader.integer("vectors", 0, int(width));
  const auto clusters = std::size_t(compressed->clusters), vectors = std::size_t(compressed->vectors);
  compressed->means = reader.numbers("means", clusters * width, half_float);
  if (vectors > 0) {
    compressed->basis = reader.numbers("basis", clusters * vectors * width, half_float);
    compressed->weights = reader.numbers("weights", points * vectors, half_float);
  }
  compressed->cluster = reader.indices("cluster", points, compressed->clusters);
  reader.charge("cluster", points * width);
  expandTransfer(*compressed, transfer);
  transfer.compressed = std::move(compressed);
}

std::shared_ptr<const CompressedTransfer> pcaOfPoints(const CompressedTransfer& compressed,
                                                      std::span<const std::uint32_t> points) {
  auto picked = std::make_shared<CompressedTransfer>(compressed);
  const auto vectors = std::size_t(compressed.vectors);
  picked->weights.clear();
  picked->cluster.clear();
  for (const std::uint32_t p : points) {
    picked->cluster.push_back(compressed.cluster[p]);
    for (std::size_t m = 0; m < vectors; ++m) picked->weights.push_back(compressed.weights[p * vectors + m]);
  }
  return picked;
}

}  // namespace gloam
