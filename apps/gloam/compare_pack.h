// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures small enough to travel in a page: page/codec.js takes them apart.
#pragma once

#include <gloam/image.h>

#include <string>

namespace gloam::cli {

/// R, G, B of a picture as halves: for each channel, differences to the left neighbour modulo 2^16 (the first of a row to
/// the one above), upper bytes, then lower bytes; zlib; base64.
std::string packedHalves(const Image& picture);
/// The first channel of a picture as bytes, 0 to 1 as 0 to 255, packed alike.
std::string packedBytes(const Image& map);
std::string base64(const void* bytes, std::size_t size);

/// Each pixel the mean of factor * factor; what is left over at the right and below is dropped.
Image shrunk(const Image& picture, int factor);

}  // namespace gloam::cli
