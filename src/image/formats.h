// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The picture formats behind gloam/image.h, each in a file of its own.
#pragma once

#include <gloam/image.h>

#include <cstdint>
#include <string>
#include <vector>

namespace gloam {

/// R, G, B (and A) or Y (and A) of an EXR file, converted to Rec. 709.
Image readExrPicture(const std::filesystem::path& path);
/// PNG or JPEG, decoded from sRGB: 1 to 4 channels.
Image readPngOrJpeg(const std::filesystem::path& path);
/// Radiance pictures in memory; `place` names the file in errors.
Image decodeHdr(const std::vector<std::uint8_t>& bytes, const std::string& place);

/// Throws Error(path, …) unless size, channels and the number of pixels agree.
void checkWritable(const Image& image, const std::filesystem::path& path);

}  // namespace gloam
