// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bake --pca: diffuse transfer as clustered principal components.
#pragma once

#include <gloam/compress.h>

#include "arguments.h"
#include "json.h"

namespace gloam::cli {

struct PcaChoice {
  bool wanted = false;
  CompressOptions options;
};
void addPcaOption(CLI::App& app, PcaChoice& choice);

/// The scene as it was, or compressed as it was asked for, with a line that tells size and error.
Scene compressedAsChosen(Scene scene, const PcaChoice& choice, bool half_float, Console& console,
                         CompressReport& report);
/// Null where nothing was asked for.
Json pcaJson(const PcaChoice& choice, const CompressReport& report);

}  // namespace gloam::cli
