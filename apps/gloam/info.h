// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "arguments.h"
#include "json.h"

namespace gloam::cli {

/// {"kind": "scene", "triangles": …, "transfer": {…}, …}. Throws Error.
Json describeScene(const std::string& name, Console& console);
/// {"kind": "image", "size", "layers": [{"name", "channels", "type", "minimum", "maximum", "mean", "non_finite"}], …} of an
/// EXR file.
Json describeLayers(const std::string& path);
/// The same for Radiance HDR, PNG and JPEG.
Json describePicture(const std::string& path);
Json describeSky(const std::string& name);

}  // namespace gloam::cli
