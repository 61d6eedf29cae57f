// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Member `pca` of GLOAM_precomputed_transfer: diffuse transfer as clustered principal components.
#pragma once

#include <gloam/compress.h>

#include "scene/gltf_transfer.h"

namespace gloam {

nlohmann::json pcaJson(const CompressedTransfer& compressed, bool half_float, GlbBuilder& builder);

/// Reads the member's object for so many points into a transfer whose order and bounces are set, and expands it. Throws Error
/// that names the field, also for an index of a cluster that is not there.
void readPca(GltfAccessors& accessors, const nlohmann::json& json, const std::string& where,
             std::size_t points, bool half_float, Transfer& transfer);

/// The same clusters for some of the points, in that order.
std::shared_ptr<const CompressedTransfer> pcaOfPoints(const CompressedTransfer& compressed,
                                                      std::span<const std::uint32_t> points);

}  // namespace gloam
