// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Virtual lights of the cells of a grid over the map (MS-2). Each has flux at the mean, weighted by flux, of where it falls. So lights
// glide as lamps and things move; none jumps from texel to texel. Between two surfaces a light would stand in the air, or behind a
// corner: where a cell holds more than one, the one with the most flux has a light, and the rest another, on the next. So light
// does not leap when a lamp's cell passes over an edge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

const float kPi = 3.14159265;

layout(local_size_x = 8) in;  // a cell
layout(set = 0, binding = 0) uniform sampler2D position_map;
layout(set = 0, binding = 1) uniform sampler2D normal_map;
layout(set = 0, binding = 2) uniform sampler2D flux_map;
layout(scalar, set = 0, binding = 3) writeonly buffer Rows { VplRow at[]; } rows;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

const int kTries = 5;
/// Places in a cell whose surfaces are tried, in sixths of its side.
const ivec2 kTried[kTries] = ivec2[kTries](ivec2(3, 3), ivec2(1, 1), ivec2(5, 1), ivec2(1, 5), ivec2(5, 5));
const float kSameNormal = 0.8, kSamePlane = 0.25;  // least cosine; rise over run
/// Texels a side of a cell; of wider ones every second, third ... is looked at. Some drivers end a shader's loops at 65,535 turns in
/// all: four loops over a cell are 32,768.
const int kMostTexels = 256;
const float kLeastRest = 0.01;  // of a cell's flux that has a light of its own
const uint kLanes = 8u;

struct Point {
  vec3 position, normal;
};

Point pointAt(ivec2 at) { return Point(texelFetch(position_map, at, 0).xyz, texelFetch(normal_map, at, 0).xyz); }

/// Whether both may be of one surface, flat or bent a little. What is not there has no normal.
bool agree(Point a, Point b) {
  vec3 between = b.position - a.position;
  return dot(a.normal, b.normal) > kSameNormal && abs(dot(between, a.normal)) <= kSamePlane * length(between) + 1e-6;
}

float fluxAt(ivec2 at) { return dot(texelFetch(flux_map, at, 0).rgb, vec3(1.0)); }

/// Flux on a surface, and where it falls.
struct Sum {
  vec3 position, normal;  // weighted by flux
  float weight;
  vec3 flux, all;  // of it; of the whole cell
  float area;      // that is lit, of the whole cell
};
const Sum kNone = Sum(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0), 0.0);

struct Cell {
  ivec2 corner, size;
  int step;
};

shared float shares[kLanes][kTries];
shared Sum sums[kLanes];

/// The tried place with the most flux about it, without what is of surface `first` if it is there; -1: none has any.
int choose(Cell cell, Point tried[kTries], bool has_first, Point first) {
  float own[kTries] = float[kTries](0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = int(gl_LocalInvocationID.x); i < cell.size.x * cell.size.y; i += int(kLanes)) {
    ivec2 at = cell.corner + cell.step * ivec2(i % cell.size.x, i / cell.size.x);
    Point point = pointAt(at);
    float w = has_first && agree(first, point) ? 0.0 : fluxAt(at);
    for (int k = 0; k < kTries; ++k) own[k] += agree(tried[k], point) ? w : 0.0;
  }
  barrier();
  for (int k = 0; k < kTries; ++k) shares[gl_LocalInvocationID.x][k] = own[k];
  barrier();
  float most = 0.0;
  int best = -1;
  for (int k = 0; k < kTries; ++k) {
    float share = 0.0;
    for (uint lane = 0u; lane < kLanes; ++lane) share += shares[lane][k];
    if (share > 1.001 * most) {
      most = share;
      best = k;
    }
  }
  return best;
}

/// What falls on surface `chosen` and not on `first`; on any where there is none chosen.
Sum sumOn(Cell cell, bool has_chosen, Point chosen, bool has_first, Point first) {
  Sum own = kNone;
  float texels = float(cell.step * cell.step);
  for (int i = int(gl_LocalInvocationID.x); i < cell.size.x * cell.size.y; i += int(kLanes)) {
    ivec2 at = cell.corner + cell.step * ivec2(i % cell.size.x, i / cell.size.x);
    Point point = pointAt(at);
    vec3 flux = texels * texelFetch(flux_map, at, 0).rgb;
    bool takes = (!has_chosen || agree(chosen, point)) && !(has_first && agree(first, point));
    float w = takes ? dot(flux, vec3(1.0)) : 0.0;
    own.position += w * point.position;
    own.normal += w * point.normal;
    own.weight += w;
    own.flux += takes ? flux : vec3(0.0);
    own.all += flux;
    own.area += any(greaterThan(flux, vec3(0.0))) ? texels * texelFetch(position_map, at, 0).w : 0.0;
  }
  barrier();
  sums[gl_LocalInvocationID.x] = own;
  barrier();
  Sum sum = kNone;
  for (uint lane = 0u; lane < kLanes; ++lane) {
    sum.position += sums[lane].position;
    sum.normal += sums[lane].normal;
    sum.weight += sums[lane].weight;
    sum.flux += sums[lane].flux;
    sum.all += sums[lane].all;
    sum.area += sums[lane].area;
  }
  return sum;
}

VplRow rowOf(Sum sum, vec3 flux) {
  float len = length(sum.normal);
  bool sends = sum.weight > 0.0 && len > 1e-6 * sum.weight;
  VplRow row;
  row.position = sends ? sum.position / sum.weight : vec3(0.0);
  row.bound = sends ? sum.area / kPi : 0.0;
  row.normal = sends ? sum.normal / len : vec3(0.0);
  row.intensity = sends ? flux / kPi : vec3(0.0);
  row.unused = row.unused_too = 0.0;
  return row;
}

void main() {
  MapPlace place = push.place;
  ivec2 at = ivec2(gl_WorkGroupID.xy), from = at * place.size / place.grid, to = (at + 1) * place.size / place.grid;
  int step = (max(to.x - from.x, to.y - from.y) + kMostTexels - 1) / kMostTexels;
  Cell cell = Cell(place.corner + from, (to - from + step - 1) / step, step);
  Point tried[kTries];
  for (int k = 0; k < kTries; ++k) tried[k] = pointAt(place.corner + from + (to - from) * kTried[k] / 6);

  int best = choose(cell, tried, false, tried[0]);
  Point first = tried[max(best, 0)];
  Sum sum = sumOn(cell, best >= 0, first, false, first);
  vec3 flux = sum.all, left = max(sum.all - sum.flux, vec3(0.0));
  uint index = uint(at.y * place.grid + at.x);
  Sum rest = kNone;
  if (dot(left, vec3(1.0)) > kLeastRest * dot(sum.all, vec3(1.0))) {
    int next = choose(cell, tried, true, first);
    if (next >= 0) rest = sumOn(cell, true, tried[next], true, first);
    if (rest.weight > 0.0) flux -= left;
  }
  if (gl_LocalInvocationID.x != 0u) return;
  rows.at[place.first + index] = rowOf(sum, flux);
  rows.at[place.first + uint(place.grid * place.grid) + index] = rowOf(rest, left);
}
