// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked numbers of a lane's vertex, as prt_packer.h lays them out. The includer defines transfer_direct and
// transfer_indirect (uint), `half_float` and kCoefficients.
#ifndef GLOAM_PRT_VALUES_GLSL
#define GLOAM_PRT_VALUES_GLSL
#include "techniques/prt/prt_shared.h"

/// Value i of a lane's vertex. Halves stand two a word.
float direct(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_direct.at[(block * kCoefficients + i) * kBlockVertices + lane]);
  uint words = (kCoefficients + 1u) / 2u;
  return unpackHalf2x16(transfer_direct.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}
float indirectValue(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_indirect.at[(block * 3u * kCoefficients + i) * kBlockVertices + lane]);
  uint words = (3u * kCoefficients + 1u) / 2u;
  return unpackHalf2x16(transfer_indirect.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}
/// Coefficient i of the three colours.
vec3 indirect(uint block, uint i, uint lane) {
  return vec3(indirectValue(block, 3u * i, lane), indirectValue(block, 3u * i + 1u, lane),
              indirectValue(block, 3u * i + 2u, lane));
}

#endif
