// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 3.5, on the host: fromCoarser of splatting_upsample.glsl for a row of texels.
#include "techniques/splatting/splatting_host.h"

namespace gloam::splatting {

void interpolateRow(const HostLevel& coarse, int row, bool keeps, int width, glm::vec4* first,
                    glm::vec4* second) {
  const glm::vec4* lights[3] = {coarse.lightRow(row - 1), coarse.lightRow(row), coarse.lightRow(row + 1)};
  const std::uint32_t* here = coarse.goes_on.data() + std::size_t(row) * std::size_t(coarse.stride);
  const std::uint32_t* above = here - (row > 0 ? coarse.stride : 0);
  for (int x = 0; 2 * x < width; ++x) {
    const bool wide = 2 * x + 1 < width;
    glm::vec4* const children[4] = {first + 2 * x, wide ? first + 2 * x + 1 : nullptr,
                                    second ? second + 2 * x : nullptr,
                                    second && wide ? second + 2 * x + 1 : nullptr};
    if (!(lights[1][x].a > 0.0f)) {
      for (glm::vec4* child : children) {
        if (child && !keeps) *child = glm::vec4(0.0f);
      }
      continue;
    }
    // A texel knows of those below and to the right of it, they know the rest. Weights of what is empty are 0.
    const auto weighted = [&](int i, bool joins, float weight) {
      const glm::vec4& texel = lights[i / 3][x + i % 3 - 1];
      return glm::vec4(glm::vec3(texel), 1.0f) * (joins && texel.a != 0.0f ? weight : 0.0f);
    };
    const bool rows_above = row > 0;
    const glm::vec4 middle = weighted(4, true, 9.0f);
    const glm::vec4 sides[2] = {weighted(3, x > 0 && (here[x - 1] & 1u) != 0, 3.0f),
                                weighted(5, (here[x] & 1u) != 0, 3.0f)};
    const glm::vec4 rows[2] = {middle + weighted(1, rows_above && (above[x] & 4u) != 0, 3.0f),
                               middle + weighted(7, (here[x] & 4u) != 0, 3.0f)};
    const bool corners[4] = {rows_above && x > 0 && (above[x - 1] & 8u) != 0,
                             rows_above && x + 1 < coarse.width && (above[x + 1] & 2u) != 0,
                             (here[x] & 2u) != 0, (here[x] & 8u) != 0};
    constexpr int kCorner[4] = {0, 2, 6, 8};
    for (int i = 0; i < 4; ++i) {
      if (!children[i] || (keeps && children[i]->a != 0.0f)) continue;
      const glm::vec4 sum = rows[i >> 1] + sides[i & 1] + weighted(kCorner[i], corners[i], 1.0f);
      *children[i] = sum / sum.a;
    }
  }
}

}  // namespace gloam::splatting
