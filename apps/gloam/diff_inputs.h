// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What `gloam diff` compares: two pictures made alike, and which of their pixels count.
#pragma once

#include <gloam/image.h>

#include <string>

namespace gloam::cli {

struct DiffInputs {
  std::string picture, reference;  ///< files
  std::string layer;               ///< of OpenEXR files; empty: the picture itself
  std::string mask;                ///< a file; empty: all pixels
  bool foreground = false;         ///< only pixels where the reference shows a surface
};

struct DiffPair {
  Image picture, reference;  ///< of one size and one or three channels, finite
  Image mask;                ///< empty: all pixels
  bool display = false;      ///< both are 8-bit pictures for a display, not radiance
};

/// Throws Error that names the file: unreadable, layer missing, sizes that differ, a pixel that is not finite, a mask that
/// takes nothing. `remark` is set where the two hold different kinds of numbers.
DiffPair readPair(const DiffInputs& inputs, std::string& remark);

}  // namespace gloam::cli
