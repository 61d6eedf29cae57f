// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The pictures of a difference that `gloam diff` writes.
#pragma once

#include <gloam/metrics.h>

#include <filesystem>
#include <string>
#include <vector>

#include "diff_inputs.h"

namespace gloam::cli {

struct DiffPictures {
  std::string folder;  ///< all of them go there by their own names, or only those that are named
  std::string difference, signed_difference, false_color, flip, ldr_flip;
  float factor = 2.0f;  ///< of both difference pictures
  float top = 1.0f;     ///< of false colour
};

/// Fills in the names that a folder implies, makes it, and throws Error where anything cannot be written, is no .png, or
/// is an input. After a failure of the work a folder that was made here is taken away again.
class DiffOutput {
 public:
  DiffOutput(DiffPictures pictures, const DiffInputs& inputs);
  ~DiffOutput();
  DiffOutput(const DiffOutput&) = delete;
  DiffOutput& operator=(const DiffOutput&) = delete;

  /// Draws and writes; pixels that the mask leaves out show no difference. The files, in order.
  std::vector<std::filesystem::path> write(const DiffPair& pair, const MetricOptions& options,
                                           const Progress& progress);

 private:
  void removeOwnFolder();

  DiffPictures pictures_;
  bool made_folder_ = false;
};

}  // namespace gloam::cli
