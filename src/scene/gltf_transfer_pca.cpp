// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_transfer_pca.h"

#include "scene/gltf_extension_reader.h"

namespace gloam {

nlohmann::json pcaJson(const CompressedTransfer& compressed, bool half_float, GlbBuilder& builder) {
  const TransferClusters& of = *compressed.of;
  nlohmann::json json = {{"clusters", of.clusters},
                         {"vectors", of.vectors},
                         {"means", builder.addSharedNumbers(of.means, half_float)}};
  if (of.vectors > 0) {
    json["basis"] = builder.addSharedNumbers(of.basis, half_float);
    json["weights"] = builder.addNumbers(compressed.weights, half_float);
  }
  if (of.clusters <= 256) {
    const std::vector<std::uint8_t> bytes(compressed.cluster.begin(), compressed.cluster.end());
    json["cluster"] = builder.addBytes(bytes, 1, GlbBuilder::Target::kNone);
  } else {
    json["cluster"] = builder.addShorts(compressed.cluster, 1, GlbBuilder::Target::kNone);
  }
  return json;
}

// Primitives may name the same clusters: those are read once.
static std::shared_ptr<const TransferClusters> readClusters(GltfAccessors& accessors,
                                                            const ExtensionReader& reader, std::size_t width,
                                                            bool half_float) {
  constexpr int kNoAccessor = -1, kMost = 0x7fffffff;
  auto of = std::make_shared<TransferClusters>();
  of->clusters = reader.integer("clusters", 1, 65536);
  of->vectors = reader.integer("vectors", 0, int(width));
  const int basis = of->vectors > 0 ? reader.integer("basis", 0, kMost) : kNoAccessor;
  std::shared_ptr<const TransferClusters>& known = accessors.transfer_clusters[{
      reader.integer("means", 0, kMost), basis, of->clusters, of->vectors, int(width), int(half_float)}];
  if (known) return known;
  const auto clusters = std::size_t(of->clusters), vectors = std::size_t(of->vectors);
  of->means = reader.numbers("means", clusters * width, half_float);
  if (vectors > 0) of->basis = reader.numbers("basis", clusters * vectors * width, half_float);
  return known = std::move(of);
}

void readPca(GltfAccessors& accessors, const nlohmann::json& json, const std::string& where,
             std::size_t points, bool half_float, Transfer& transfer) {
  const ExtensionReader reader(accessors, json, where);
  auto compressed = std::make_shared<CompressedTransfer>();
  const auto direct = std::size_t(transfer.order * transfer.order);
  const std::size_t width = transfer.bounces > 0 ? 4 * direct : direct;
  compressed->of = readClusters(accessors, reader, width, half_float);
  const auto vectors = std::size_t(compressed->of->vectors);
  if (vectors > 0) compressed->weights = reader.numbers("weights", points * vectors, half_float);
  compressed->cluster = reader.indices("cluster", points, compressed->of->clusters);
  reader.charge("cluster", points * width);
  expandTransfer(*compressed, transfer);
  transfer.compressed = std::move(compressed);
}

std::shared_ptr<const CompressedTransfer> pcaOfPoints(const CompressedTransfer& compressed,
                                                      std::span<const std::uint32_t> points) {
  auto picked = std::make_shared<CompressedTransfer>();
  picked->of = compressed.of;
  const auto vectors = std::size_t(compressed.of->vectors);
  for (const std::uint32_t p : points) {
    picked->cluster.push_back(compressed.cluster[p]);
    for (std::size_t m = 0; m < vectors; ++m) picked->weights.push_back(compressed.weights[p * vectors + m]);
  }
  return picked;
}

}  // namespace gloam
