// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, sections 3.2 to 3.5 on the host: bands of the picture side by side, each from ranges to light by itself; then
// level by level from coarse to fine. What differs from the paper stands in the shaders of the same passes.
#include "techniques/splatting/splatting_host.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "techniques/splatting/splatting_host_simd.h"

namespace gloam::splatting {

namespace {

/// As splatting_coarse.comp.glsl.
constexpr float kLeastCosine = 0.25f;
constexpr int kMultiple = int(HostPoints::kMultiple);

float signOrOne(float v) {
  return v < 0.0f ? -1.0f : 1.0f;
}

/// Twin of unpackNormal of frame/gbuffer.glsl.
glm::vec3 unpackNormal(std::uint32_t word) {
  const auto part = [](std::uint32_t bits) {
    return std::max(float(std::int16_t(std::uint16_t(bits))) / 32767.0f, -1.0f);
  };
  const float x = part(word & 0xffffu), y = part(word >> 16), z = 1.0f - std::abs(x) - std::abs(y);
  if (z >= 0.0f) return glm::normalize(glm::vec3(x, y, z));
  return glm::normalize(
      glm::vec3((1.0f - std::abs(y)) * signOrOne(x), (1.0f - std::abs(x)) * signOrOne(y), z));
}

std::uint32_t placeOf(int x, int y) {
  return std::uint32_t(x) | std::uint32_t(y) << 16;
}
glm::ivec2 texelAt(std::uint32_t place) {
  return {int(place & 0xffffu), int((place & ~kSplit) >> 16)};
}

}  // namespace

void HostLevel::shape(int texels_across, int texels_down) {
  if (width == texels_across && height == texels_down) return;
  width = texels_across;
  height = texels_down;
  stride = (width + 4 * kMultiple) / (2 * kMultiple) * 2 * kMultiple + 2 * kMultiple;
  const std::size_t plane_size = std::size_t(stride) * std::size_t(height + 1);
  planes.assign(kPlanes * plane_size, 0.0f);
  const auto fill = [&](int which, float value) {
    std::fill_n(planes.data() + std::size_t(which) * plane_size, plane_size, value);
  };
  for (int c = 0; c < 3; ++c) {
    fill(kLowX + c, 1.0f);
    fill(kHighX + c, -1.0f);
  }
  fill(kFar, 2.0f);
  light.assign(std::size_t(width + 2) * std::size_t(height + 2), glm::vec4(0.0f));
  goes_on.assign(plane_size, 15u);
}

glm::vec4* HostLevel::lightRow(int row) {
  return light.data() + std::size_t(row + 1) * std::size_t(width + 2) + 1;
}
const glm::vec4* HostLevel::lightRow(int row) const {
  return const_cast<HostLevel*>(this)->lightRow(row);
}

std::size_t HostPoints::add() {
  if (count == x.size()) {
    const std::size_t more = std::max<std::size_t>(1024, 2 * x.size());
    for (auto* part :
         {&x, &y, &z, &normal_x, &normal_y, &normal_z, &side, &red, &green, &blue, &change, &error})
      part->resize(more);
    place.resize(more);
    level.resize(more);
  }
  return count++;
}

namespace {

/// Where a place is, without what it got.
void addPlace(const HostPoints& from, std::size_t i, HostPoints& to) {
  const std::size_t j = to.add();
  to.x[j] = from.x[i], to.y[j] = from.y[i], to.z[j] = from.z[i];
  to.normal_x[j] = from.normal_x[i], to.normal_y[j] = from.normal_y[i], to.normal_z[j] = from.normal_z[i];
  to.place[j] = from.place[i];
  to.level[j] = from.level[i];
}

}  // namespace

/// One picture, as all bands see it.
struct HostSplatting::Frame {
  const HostPlan& plan;
  const HostLights& lights;
  std::span<const float> depth;
  std::span<const glm::uvec2> normals;
  std::span<glm::vec4> irradiance;

  bool merges() const { return lights.sets.size() > 1; }
  std::size_t pixel(glm::ivec2 at) const {
    return std::size_t(at.y) * std::size_t(plan.width) + std::size_t(at.x);
  }
  bool isCovered(const std::vector<HostLevel>& levels, int level, glm::ivec2 at) const {
    if (level == 0) return at.x < plan.width && at.y < plan.height && depth[pixel(at)] > 0.0f;
    const HostLevel& texels = levels[std::size_t(level)];
    return at.x < texels.width && at.y < texels.height && texels.plane(kCovered, at.y)[at.x] > 0.0f;
  }
  /// Whether too much varies within a texel.
  bool varies(const HostLevel& level, glm::ivec2 at) const {
    const auto value = [&](int p) { return level.plane(p, at.y)[at.x]; };
    float span = 0.0f;
    for (int c = 0; c < 3; ++c) span = std::max(span, value(kHighX + c) - value(kLowX + c));
    const float near = value(kNear), far = value(kFar), range = plan.view.depth_range;
    const float apart =
        range <= 0.0f ? near / std::max(far, 1e-30f) - 1.0f
                      : (near - far) * range / std::max(plan.view.z_near + (1.0f - near) * range, 1e-30f);
    return span >= plan.thresholds.normal || apart >= plan.thresholds.depth;
  }
  /// Where a texel receives, as pointOf of splatting_coarse.comp.glsl.
  void place(const std::vector<HostLevel>& levels, int level, std::uint32_t place, HostPoints& points) const {
    const glm::ivec2 at = texelAt(place);
    glm::vec2 middle(0.5f);
    glm::vec3 normal;
    float d = 0.0f;
    if (level == 0) {
      d = depth[pixel(at)];
      normal = unpackNormal(normals[pixel(at)].x);
    } else {
      const HostLevel& texels = levels[std::size_t(level)];
      const auto value = [&](int p) { return texels.plane(p, at.y)[at.x]; };
      d = value(kDepth);
      normal = {value(kNormalX), value(kNormalY), value(kNormalZ)};
      middle = {value(kMiddleX), value(kMiddleY)};
    }
    const frame::FrameView& view = plan.view;
    const bool orthographic = view.depth_range > 0.0f;
    const auto size = float(1 << level);
    const glm::vec2 pixel_place = (glm::vec2(at) + middle) * size;
    const glm::vec3 offset = view.corner + pixel_place.x * view.step_x + pixel_place.y * view.step_y;
    const float along =
        orthographic ? view.z_near + (1.0f - d) * view.depth_range : view.z_near / std::max(d, 1e-30f);
    const glm::vec3 position =
        orthographic ? view.eye + offset + view.forward * along : view.eye + offset * along;
    const glm::vec3 to_eye = orthographic ? -view.forward : -glm::normalize(offset);
    const float cosine = std::max(glm::dot(normal, to_eye), kLeastCosine);
    const std::size_t i = points.add();
    points.x[i] = position.x, points.y[i] = position.y, points.z[i] = position.z;
    points.normal_x[i] = normal.x, points.normal_y[i] = normal.y, points.normal_z[i] = normal.z;
    points.side[i] = size * std::max(glm::length(view.step_x), glm::length(view.step_y)) *
                     (orthographic ? 1.0f : along) / cosine;
    points.place[i] = place;
    points.level[i] = std::uint32_t(level);
  }
};

void HostSplatting::keepLight(const HostPoints& from, std::size_t i, Band& band) {
  const glm::ivec2 at = texelAt(from.place[i]);
  const glm::vec4 light(from.red[i], from.green[i], from.blue[i],
                        (from.place[i] & kSplit) != 0 ? -1.0f : 1.0f);
  if (from.level[i] == 0)
    band.pixels.emplace_back(from.place[i], light);
  else
    levels_[from.level[i]].lightRow(at.y)[at.x] = light;
}

void HostSplatting::look(const Frame& frame, Band& band, int level) {
  const HostPlan& plan = frame.plan;
  HostPoints& points = band.looked;
  points.clear();
  for (const std::uint32_t place : band.leaves[std::size_t(level)])
    frame.place(levels_, level, place, points);
  band.counts.leaves[level] += std::uint32_t(points.count);
  const bool splits = level > 0 && plan.light_threshold > 0.0f;
  gatherOnHost(frame.lights.sets.back(), plan.bound_kind, splits, frame.merges(), points);
  const float squared = plan.light_threshold * plan.light_threshold;
  for (std::size_t i = 0; i < points.count; ++i) {
    const float all = points.red[i] + points.green[i] + points.blue[i];
    if (splits && points.side[i] * points.side[i] * points.change[i] > squared * all) {
      const glm::ivec2 corner = 2 * texelAt(points.place[i]);
      for (int c = 0; c < 4; ++c) {
        const glm::ivec2 child = corner + glm::ivec2(c & 1, c >> 1);
        if (frame.isCovered(levels_, level - 1, child))
          band.leaves[std::size_t(level - 1)].push_back(placeOf(child.x, child.y));
      }
      points.place[i] |= kSplit;
    }
    const bool finer =
        frame.merges() && (plan.cluster_threshold <= 0.0f || points.error[i] > plan.cluster_threshold * all);
    if (!finer) {
      keepLight(points, i, band);
      continue;
    }
    addPlace(points, i, band.listed);
  }
}

/// Sets of more and more lights, for those whom the one before did not do.
void HostSplatting::gatherFiner(const Frame& frame, Band& band) {
  const HostPlan& plan = frame.plan;
  for (std::size_t s = frame.lights.sets.size() - 1; s-- > 0 && band.listed.count > 0;) {
    HostPoints& points = band.listed;
    band.counts.listed[s] += std::uint32_t(points.count);
    gatherOnHost(frame.lights.sets[s], plan.bound_kind, false, s > 0, points);
    band.fewer.clear();
    for (std::size_t i = 0; i < points.count; ++i) {
      const float all = points.red[i] + points.green[i] + points.blue[i];
      if (s > 0 && (plan.cluster_threshold <= 0.0f || points.error[i] > plan.cluster_threshold * all))
        addPlace(points, i, band.fewer);
      else
        keepLight(points, i, band);
    }
    std::swap(band.listed, band.fewer);
  }
}

void HostSplatting::refine(const Frame& frame, Band& band, int row) {
  const int coarsest = frame.plan.coarsest;
  band.queues.resize(std::size_t(coarsest + 1));
  band.leaves.resize(std::size_t(coarsest + 1));
  for (auto* lists : {&band.queues, &band.leaves}) {
    for (std::vector<std::uint32_t>& list : *lists) list.clear();
  }
  band.listed.clear();
  band.pixels.clear();
  band.counts = {};
  std::vector<float> scratch;
  for (int k = 1; k <= coarsest; ++k) {
    HostLevel& level = levels_[std::size_t(k)];
    const int rows = 1 << (coarsest - k);
    for (int y = row * rows; y < std::min((row + 1) * rows, level.height); ++y) {
      if (k == 1)
        rangesOfPixels(frame.plan, frame.depth.data(), frame.normals.data(), y, scratch, level);
      else
        rangesOfTexels(levels_[std::size_t(k - 1)], y, level);
      std::fill_n(level.lightRow(y), level.width, glm::vec4(0.0f));
    }
  }
  for (int x = 0; x < levels_.back().width; ++x) band.queues.back().push_back(placeOf(x, row));
  for (int k = coarsest; k > 0; --k) {
    const HostLevel& level = levels_[std::size_t(k)];
    auto& children = k == 1 ? band.leaves[0] : band.queues[std::size_t(k - 1)];
    for (const std::uint32_t place : band.queues[std::size_t(k)]) {
      const glm::ivec2 at = texelAt(place);
      if (!(level.plane(kNear, at.y)[at.x] > 0.0f)) continue;
      if (!frame.varies(level, at)) {
        band.leaves[std::size_t(k)].push_back(place);
        continue;
      }
      for (int c = 0; c < 4; ++c) {
        const glm::ivec2 child = 2 * at + glm::ivec2(c & 1, c >> 1);
        if (frame.isCovered(levels_, k - 1, child)) children.push_back(placeOf(child.x, child.y));
      }
    }
    look(frame, band, k);
  }
  look(frame, band, 0);
  gatherFiner(frame, band);
}

void HostSplatting::splat(const HostPlan& plan, const HostLights& lights, std::span<const float> depth,
                          std::span<const glm::uvec2> normals, std::span<glm::vec4> irradiance) {
  const Frame frame{plan, lights, depth, normals, irradiance};
  levels_.resize(std::size_t(plan.coarsest + 1));
  for (int k = 1; k <= plan.coarsest; ++k)
    levels_[std::size_t(k)].shape((plan.width + (1 << k) - 1) >> k, (plan.height + (1 << k) - 1) >> k);
  bands_.resize(std::size_t(levels_.back().height));
  tbb::parallel_for(0, levels_.back().height, [&](int row) { refine(frame, bands_[std::size_t(row)], row); });
  counts_ = {};
  for (const Band& band : bands_) {
    for (int k = 0; k <= plan.coarsest; ++k) {
      counts_.leaves[k] += band.counts.leaves[k];
      counts_.subsplats += band.counts.leaves[k];
    }
    for (int s = 0; s < kMostSets; ++s) counts_.listed[s] += band.counts.listed[s];
  }
  for (int k = plan.coarsest; k > 0; --k) {
    HostLevel &level = levels_[std::size_t(k)], &finer = levels_[std::size_t(k - 1)];
    tbb::parallel_for(0, level.height, [&](int row) {
      if (plan.along_surfaces)
        relateRow(plan, row, level);
      else
        std::fill_n(level.goes_on.data() + std::size_t(row) * std::size_t(level.stride), level.stride, 15u);
    });
    tbb::parallel_for(0, level.height, [&](int row) {
      const auto rowOf = [&](int y) -> glm::vec4* {
        if (k > 1) return y < finer.height ? finer.lightRow(y) : nullptr;
        return y < plan.height ? irradiance.data() + frame.pixel({0, y}) : nullptr;
      };
      interpolateRow(level, row, k > 1, k > 1 ? finer.width : plan.width, rowOf(2 * row), rowOf(2 * row + 1));
    });
  }
  tbb::parallel_for(std::size_t(0), bands_.size(), [&](std::size_t b) {
    for (const auto& [place, light] : bands_[b].pixels) irradiance[frame.pixel(texelAt(place))] = light;
  });
}

}  // namespace gloam::splatting
