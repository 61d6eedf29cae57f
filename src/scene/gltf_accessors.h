// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Numbers out of accessors: every component type, normalised or not, interleaved, sparse, compressed.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "scene/gltf_document.h"

namespace gloam {

struct TransferClusters;

/// Where the elements of an accessor lie. Ranges were checked: any element below `count` may be read.
struct AccessorView {
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0, count = 0;
  int component_type = 0;
  int components = 0;
  bool normalized = false;

  /// Normalised integers come as -1..1 or 0..1 (glTF 2.0 specification, section 3.6.2.2).
  float number(std::size_t element, int component) const;
  /// For integer component types.
  std::uint32_t integer(std::size_t element, int component) const;
};

std::size_t componentBytes(int component_type);
int componentsOf(const std::string& accessor_type);

/// Holds accessor and sparse ranges against their buffer views. Throws Error.
void checkAccessor(const GltfDocument& document, const nlohmann::json& accessor, const std::string& where);

class GltfAccessors {
 public:
  explicit GltfAccessors(GltfDocument& document) : document_(document) {}

  /// Sparse accessors and those without a buffer view are written out once. The view lives as long as this object.
  AccessorView view(int accessor);
  /// All elements as floats, `components` each. Throws where the accessor's type is another or a value is not finite.
  /// `where` is who asks: animations[0].samplers[1].output.
  std::vector<float> floats(int accessor, int components, const std::string& where);

  GltfDocument& document() { return document_; }

  /// What primitives may share, by the accessors and sizes that they name (gltf_transfer_pca.cpp).
  std::map<std::array<int, 6>, std::shared_ptr<const TransferClusters>> transfer_clusters;

 private:
  Bytes writtenOut(int accessor, const std::string& where);
  GltfDocument& document_;
  std::map<int, Bytes> written_out_;
};

/// Picks elements `at` into vectors of VecT::length() components; missing ones stay as in `otherwise`.
template <typename VecT>
std::vector<VecT> gather(const AccessorView& view, std::span<const std::uint32_t> at,
                         const VecT& otherwise = VecT(0.0f)) {
  std::vector<VecT> out(at.size(), otherwise);
  const int components = std::min<int>(view.components, VecT::length());
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int c = 0; c < components; ++c) out[i][c] = view.number(at[i], c);
  return out;
}

}  // namespace gloam
