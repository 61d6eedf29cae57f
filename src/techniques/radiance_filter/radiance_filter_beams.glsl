// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Beyond RF-5: what three bands cut off, put back where they tell that light comes from one or two places. A beam of strength E about d,
// in the family of cosine lobes cos^s (b_1 = (s + 1) / (s + 2), b_2 = s / (s + 3), as Phong's in RF-5), has in one colour
//     e_0 = E,  V = E b_1 d,  Q = E b_2 (3/2 d d^T - 1/2),  light(w) = (e_0 + 3 V.w + 5 w.Qw) / 4 pi.
// Two of one s and light from everywhere beside them: Q's least eigenvalue q < 0 belongs to the normal of their plane, in which
// N = (Q - q) / (-3 q) = sum w_i d_i d_i^T, w_1 + w_2 = 1. V = k sum w_i d_i, and as unit vectors in a plane have sum w_i d_i d_i^T less
// mean mean^T of rank one, V^T N^-1 V = k^2 = (E b_1)^2: hence b_2 / b_1 = -2 q / k, s and E; and d_i are where the line through
// V / k along what is left meets the circle. Light from everywhere has no such plane, and stays what it is. Bands 0 to 2 of what is
// put back are 0: no light comes or goes.
#ifndef GLOAM_RADIANCE_FILTER_BEAMS_GLSL
#define GLOAM_RADIANCE_FILTER_BEAMS_GLSL
#include "math/brdf.glsl"

const float kSharpestBeam = 1e3;

float bandOne(float s) { return (s + 1.0) / (s + 2.0); }
float bandTwo(float s) { return s / (s + 3.0); }
/// The exponent whose first band is b.
float exponentOfBandOne(float b) { return max(2.0 * b - 1.0, 0.0) / (1.0 - b); }
/// The exponent whose bands are b_2 / b_1 = r.
float exponentOfRatio(float r) {
  float middle = 2.0 * r - 1.0;
  return (middle + sqrt(middle * middle + 3.0 * r * (1.0 - r))) / (1.0 - r);
}

struct Beam {
  vec3 direction;
  float strength;
};
struct Beams {
  Beam at[2];
  float exponent;
};

/// The unit eigenvector of a symmetric matrix of eigenvalue `value`.
vec3 eigenvectorOf(mat3 q, float value) {
  mat3 rows = q - mat3(value);
  vec3 a = cross(rows[0], rows[1]), b = cross(rows[1], rows[2]), c = cross(rows[2], rows[0]);
  vec3 best = dot(a, a) > dot(b, b) ? a : b;
  best = dot(best, best) > dot(c, c) ? best : c;
  float length_ = length(best);
  return length_ > 0.0 ? best / length_ : vec3(0.0, 0.0, 1.0);
}

/// Of a symmetric matrix without trace.
float leastEigenvalue(mat3 q) {
  float p = sqrt((dot(q[0], q[0]) + dot(q[1], q[1]) + dot(q[2], q[2])) / 6.0);
  if (!(p > 0.0)) return 0.0;
  return 2.0 * p * cos(acos(clamp(0.5 * determinant(q / p), -1.0, 1.0)) / 3.0 + 2.0943951);
}

/// Of one colour of a field; of strength 0 where there are none.
Beams beamsOf(const vec3 light[9], int color) {
  const float zero = 3.5449077, one = 2.0466534, off = 1.3729382, on = 0.7926655;  // 4 pi / (2 l + 1) times constants of y_lm
  float all = zero * light[0][color];
  vec3 v = one * vec3(light[3][color], light[1][color], light[2][color]);
  float xy = off * light[4][color], yz = off * light[5][color], xz = off * light[7][color];
  float zz = on * light[6][color], xx_yy = off * light[8][color];
  mat3 q = mat3(xx_yy - zz, xy, xz, xy, -xx_yy - zz, yz, xz, yz, 2.0 * zz);
  Beam none = Beam(vec3(0.0, 0.0, 1.0), 0.0);
  float least = leastEigenvalue(q);
  vec3 across = eigenvectorOf(q, least), u = v - dot(v, across) * across;
  float along = length(u);
  if (!(least < -1e-4 * all && along > 1e-3 * all)) return Beams(Beam[2](none, none), 0.0);
  u /= along;
  // N in the plane, u along V.
  vec3 w = cross(across, u), nu = (q * u - least * u) / (-3.0 * least), nw = (q * w - least * w) / (-3.0 * least);
  float uu = dot(u, nu), uw = dot(u, nw), ww = dot(w, nw);
  float k = along * sqrt(max(ww, 1e-4) / max(uu * ww - uw * uw, 1e-4 * uu));
  float s = min(exponentOfRatio(clamp(-2.0 * least / k, 0.0, 0.9995)), kSharpestBeam);
  float strength = min(k / bandOne(s), all), mean = min(along / k, 1.0);
  vec2 t = ww > 1e-5 ? normalize(vec2(uw, ww)) : vec2(0.0, 1.0);
  float middle = -mean * t.x, reach_ = sqrt(max(middle * middle + 1.0 - mean * mean, 0.0));
  float share = reach_ > 1e-4 ? clamp(0.5 - 0.5 * middle / reach_, 0.0, 1.0) : 0.5;
  vec3 way = t.x * u + t.y * w;
  return Beams(Beam[2](Beam(normalize(mean * u + (middle + reach_) * way), share * strength),
                       Beam(normalize(mean * u + (middle - reach_) * way), (1.0 - share) * strength)),
               s);
}

/// What Phong's lobe of exponent n makes of beams, less what its three bands of exponent `shown` do. The product's first band tells the
/// exponent of the lobe that stands for both.
float glossBeyond(Beams beams, float n, float shown, vec3 mirror) {
  float s = beams.exponent, m = exponentOfBandOne(bandOne(s) * bandOne(n)), sum = 0.0;
  for (int i = 0; i < 2; ++i) {
    float c = dot(mirror, beams.at[i].direction);
    float bands = 1.0 + 3.0 * bandOne(s) * bandOne(shown) * c + 2.5 * bandTwo(s) * bandTwo(shown) * (3.0 * c * c - 1.0);
    sum += beams.at[i].strength * (phongLobe(m, mirror, beams.at[i].direction) - 0.25 * kInvPi * bands);
  }
  return smoothstep(0.0, 1.0, m) * sum;  // the lobe of 0 is a half sphere, with an edge
}

/// Bands 4 and 6 of the clamped cosine.
float irradianceBeyond(Beams beams, vec3 normal) {
  float s = beams.exponent, b4 = bandTwo(s) * (s - 2.0) / (s + 5.0), b6 = b4 * (s - 4.0) / (s + 7.0), sum = 0.0;
  for (int i = 0; i < 2; ++i) {
    float c = dot(normal, beams.at[i].direction), x = c * c;
    float p4 = ((35.0 * x - 30.0) * x + 3.0) / 8.0, p6 = (((231.0 * x - 315.0) * x + 105.0) * x - 5.0) / 16.0;
    sum += beams.at[i].strength * (13.0 / 256.0 * max(b6, 0.0) * p6 - 9.0 / 96.0 * max(b4, 0.0) * p4);
  }
  return sum;
}

#endif
