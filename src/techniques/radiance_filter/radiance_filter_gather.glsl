// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums over the virtual lights of a point's set that it sees. Includers define GLOAM_VALUES, how many halves a part is, declare
// addLight(values, light, to_light) and prepare(pixel, point), and stand this file behind both.
#ifndef GLOAM_RADIANCE_FILTER_GATHER_GLSL
#define GLOAM_RADIANCE_FILTER_GATHER_GLSL

layout(constant_id = 0) const int step = 0;  // 0: one set; else one of a sum over sets: 1 the first, 2, 3 the last
layout(constant_id = 1) const int parts = 1;
layout(constant_id = 2) const bool for_host = false;  // values go where the host reads them

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Points { SightPoint at[]; } points;
layout(scalar, set = 0, binding = 1) readonly buffer Rows { WalkVpl at[]; } rows;
layout(scalar, set = 0, binding = 2) readonly buffer Sets { SightSet at[]; } sets;
layout(scalar, set = 0, binding = 3) readonly buffer Visible { uint at[]; } visible;
layout(scalar, set = 0, binding = 4) readonly buffer Exposure { float at[]; } exposure;
layout(set = 0, binding = 5) uniform writeonly image2DArray values;
layout(set = 0, binding = 6, rgba32f) uniform image2DArray sums;
layout(scalar, buffer_reference, buffer_reference_align = 8) writeonly buffer HostValues { uvec2 at[]; };  // layers of rows of four halves

const float kLargestHalf = 65504.0;

/// Bits of rows begin … end - 1 in a word of a point's.
uint wordOf(uint index, uint point_count, uint word, uint begin, uint end) {
  uint low = 32u * word, bits = visible.at[word * point_count + index];
  if (begin > low) bits &= begin - low >= 32u ? 0u : 0xffffffffu << (begin - low);
  if (end < low + 32u) bits &= end <= low ? 0u : 0xffffffffu >> (low + 32u - end);
  return bits;
}

/// One loop over all words, as software drivers like it (proxies_tile_list.glsl).
void addRows(inout float sum[GLOAM_VALUES], uint index, uint point_count, SightPoint point, uint begin, uint end) {
  uint first = sets.at[point.set].first, word = begin / 32u, words = (end + 31u) / 32u, left = 0u;
  while (left == 0u && word < words) left = wordOf(index, point_count, word++, begin, end);
  if (left == 0u) return;
  do {
    uint row = first + (word - 1u) * 32u + uint(findLSB(left));
    WalkVpl vpl = rows.at[row];
    if (vpl.bounce > 0u) vpl.bound *= push.gather.interleaving.bound;
    vec3 to_light;
    vec3 light = walkIrradiance(vpl, point.position, to_light);
    addLight(sum, light, to_light);
    left &= left - 1u;
    while (left == 0u && word < words) left = wordOf(index, point_count, word++, begin, end);
  } while (left != 0u);
}

/// Sums go on over sets; halves come out of the last.
void keep(float sum[GLOAM_VALUES], int part, ivec2 pixel, float weight) {
  const int layers = GLOAM_VALUES / 4;
  sum[GLOAM_VALUES - 1] = weight;
  vec4 scale = vec4(exposure.at[0] / (step == 3 ? float(sets.at.length()) : 1.0));
  for (int i = 0; i < layers; ++i) {
    ivec3 place = ivec3(pixel, part * layers + i);
    vec4 four = vec4(sum[4 * i], sum[4 * i + 1], sum[4 * i + 2], sum[4 * i + 3]);
    if (step == 2 || step == 3) four += imageLoad(sums, place);
    if (i == layers - 1) four.a = weight, scale.a = 1.0;
    if (step == 1 || step == 2) {
      imageStore(sums, place, four);
      continue;
    }
    vec4 kept = clamp(four * scale, -kLargestHalf, kLargestHalf);
    if (for_host) {
      uint row = uint(place.z) * push.gather.interleaving.height + uint(place.y);
      HostValues(push.gather.host_values).at[row * push.gather.interleaving.width + uint(place.x)] = uvec2(packHalf2x16(kept.xy), packHalf2x16(kept.zw));
    } else {
      imageStore(values, place, kept);
    }
  }
}

void main() {
  Interleaving in_ = push.gather.interleaving;
  ivec2 place = pixelOfPoint(in_, gl_GlobalInvocationID);
  if (isBeyondTile(in_, gl_GlobalInvocationID) || !isInPicture(in_, place)) return;
  uint index = pointIndex(in_, gl_GlobalInvocationID), point_count = in_.tile_width * in_.tile_height * in_.sets_x * in_.sets_y;
  SightPoint point = points.at[index];
  bool covered = point.normal != vec3(0.0);
  if (covered) prepare(place, point);
  uint direct = sets.at[point.set].direct, count = sets.at[point.set].count;
  for (uint part = 0u; part < uint(parts); ++part) {
    float sum[GLOAM_VALUES];
    for (int i = 0; i < GLOAM_VALUES; ++i) sum[i] = 0.0;
    uint begin = part == 0u ? 0u : direct, end = part + 1u == uint(parts) ? count : direct;
    if (covered) addRows(sum, index, point_count, point, begin, end);
    keep(sum, int(part), place, covered ? 1.0 : 0.0);
  }
}

#endif
