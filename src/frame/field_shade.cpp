// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007, "Image-based proxy accumulation for real-time soft global illumination", eq. 10:
// the light's product matrix, cosine applied, takes the place of a product a receiver.
#include "frame/field_shade.h"

namespace gloam::frame {

void shadeRows(const sh::ShRgb& light, glm::vec3 rows[144]) {
  for (int channel = 0; channel < 3; ++channel) {
    sh::Sh one(light.order);
    for (int i = 0; i < light.size(); ++i) one[i] = light[i][channel];
    const sh::ShMatrix matrix = sh::productMatrix(one, 3, kFieldOrder);
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 9; ++j) {
        const int band = j == 0 ? 0 : j < 4 ? 1 : 2;
        rows[9 * i + j][channel] = matrix.at(i, j) * sh::clampedCosineFactor(band);
      }
    }
  }
}

glm::vec4 bandFactors(const sh::Zh& zonal) {
  glm::vec4 factors;
  for (int l = 0; l < kFieldOrder; ++l) factors[l] = zonal[l] * sh::zonalFactor(l);
  return factors;
}

}  // namespace gloam::frame
