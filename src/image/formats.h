// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The picture formats behind gloam/image.h, each in a file of its own.
#pragma once

#include <gloam/image.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gloam {

/// R, G, B (and A) or Y (and A) of an EXR file, converted to Rec. 709.
Image readExrPicture(const std::filesystem::path& path);
/// PNG or JPEG, decoded from sRGB: 1 to 4 channels.
Image readPngOrJpeg(const std::filesystem::path& path);
/// Throws Error unless every PNG chunk (length, name, data, checksum) up to IEND, every JPEG segment up to EOI, lies in the
/// bytes: the decoder fills what is missing with zeros and says nothing.
void checkPngIsWhole(std::span<const std::uint8_t> bytes, const std::string& place);
void checkJpegIsWhole(std::span<const std::uint8_t> bytes, const std::string& place);

/// Radiance pictures in memory; `place` names the file in errors.
Image decodeHdr(const std::vector<std::uint8_t>& bytes, const std::string& place);

/// Throws Error(path, …) unless size, channels and the number of pixels agree.
void checkWritable(const Image& image, const std::filesystem::path& path);

}  // namespace gloam
