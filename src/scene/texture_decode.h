// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures that materials use, from their encoded bytes.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <span>
#include <string>

#include "scene/read_budget.h"

namespace gloam {

/// Decodes PNG, JPEG, BMP or TGA to 8-bit RGBA. Throws Error(place, "where: …"): not such a picture, broken, larger than
/// 16384 on a side or 67 million pixels, beyond the budget. `name` is kept.
Texture decodeTexture(std::span<const std::uint8_t> bytes, const std::string& name, const std::string& place,
                      const std::string& where, ReadBudget& budget);

}  // namespace gloam
