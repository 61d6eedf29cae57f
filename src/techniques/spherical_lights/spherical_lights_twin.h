// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Slow, obvious twins of the kernels, for tests: every sum written out, sorted lists, no sharing.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/sh_log_exp.h"
#include "spheres/receiver_rule.h"
#include "techniques/spherical_lights/spherical_lights_prepare.h"
#include "techniques/spherical_lights/spherical_lights_rows.h"
#include "techniques/spherical_lights/spherical_lights_tables.h"

namespace gloam::spherical_lights {

struct TwinLight {
  glm::vec3 direct{0.0f}, indirect{0.0f};
};

class Twin {
 public:
  Twin(Rows rows, const sh::ShRgb& light, Average average, int blocking, bool difference)
      : rows_(std::move(rows)),
        light_(sh::truncated(light, 4)),
        logs_(sh::makeLogBlockerTable(4, kLogEntries)),
        averages_(averageTable(average)) {
    for (const SentRow& row : rows_.glow) {
      glow_.emplace_back(4);
      for (int i = 0; i < 16; ++i) glow_.back()[i] = row.at[i];
    }
    const auto cells = voronoiSums();
    for (std::size_t s = 0; s < rows_.spheres.size(); ++s) {
      sh::ShRgb lit(4);
      for (std::size_t j = 0; j < cells.size(); ++j) {
        const PointRow& point = rows_.points[s * kDirections + j];
        const glm::vec3 leaving =
            point.sends * at(point.position, point.normal, blocking, difference).direct / 3.14159265f;
        for (int i = 0; i < 16; ++i) lit[i] += leaving * cells[j][i];
      }
      sh::ShRgb sent(4);
      for (int c = 0; c < 3; ++c) {
        sh::Sh f(4), g(4);
        for (int i = 0; i < 16; ++i) f[i] = lit[i][c], g[i] = rows_.senders[s].albedo[i][c];
        const sh::Sh product = sh::product(f, g);
        for (int i = 0; i < 16; ++i) sent[i][c] = product[i];
      }
      sent_.push_back(sent);
    }
  }
  /// As long as spheres have not turned, else what the kernel's buffer has is to be held against turned ones.
  const std::vector<sh::ShRgb>& sent() const { return sent_; }
  void turn(std::size_t sphere, const glm::mat3& world_from_shape) {
    sent_[sphere] = sh::rotate(world_from_shape, sent_[sphere]);
  }

  TwinLight at(const glm::vec3& p, const glm::vec3& n, int blocking, bool difference) const {
    TwinLight light;
    light.direct = through(all(p, n), n);
    for (std::size_t i = 0; i < rows_.spheres.size(); ++i) {
      const spheres::SeenSphere seen = see(p, n, i);
      if (!(seen.sin_half_angle > 0.0f)) continue;
      sh::Sh before(4);
      for (std::size_t j = 0; j < rows_.spheres.size(); ++j) {
        if (blocks(p, j, i, blocking)) before += logOf(p, n, j);
      }
      const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(4), n);
      float share = 0.0f;
      if (difference) {
        sh::Sh behind = before;
        behind += logOf(p, n, i);
        share = sh::dot(sh::expQuadratic(before), cosine) - sh::dot(sh::expQuadratic(behind), cosine);
      } else {
        const sh::Sh disc = sh::disc(4, seen.direction, std::asin(seen.sin_half_angle));
        share = sh::dot(sh::product(sh::expQuadratic(before), disc), cosine);
      }
      if (i < sent_.size()) light.indirect += std::max(0.0f, share) * average(sent_[i], seen);
      if (i < glow_.size()) light.direct += std::max(0.0f, share) * average(glow_[i], seen);
    }
    return light;
  }

 private:
  spheres::SeenSphere see(const glm::vec3& p, const glm::vec3& n, std::size_t i) const {
    return spheres::seenSphere(p, n, rows_.spheres[i].center, rows_.spheres[i].radius);
  }
  sh::Sh logOf(const glm::vec3& p, const glm::vec3& n, std::size_t i) const {
    const spheres::SeenSphere seen = see(p, n, i);
    sh::Sh log = sh::rotateZonal(logs_.at(seen.sin_half_angle), seen.direction);
    log *= rows_.spheres[i].blocks;
    return log;
  }
  sh::Sh all(const glm::vec3& p, const glm::vec3& n) const {
    sh::Sh sum(4);
    for (std::size_t i = 0; i < rows_.spheres.size(); ++i) sum += logOf(p, n, i);
    return sum;
  }
  /// Irradiance of the environment behind what these logs leave.
  glm::vec3 through(const sh::Sh& logs, const glm::vec3& n) const {
    return glm::max(glm::vec3(0.0f), sh::irradiance(sh::product(light_, sh::expQuadratic(logs)), n));
  }
  static bool nearer(float a, std::size_t i, float b, std::size_t j) { return a < b || (a == b && i < j); }
  bool blocks(const glm::vec3& p, std::size_t j, std::size_t i, int blocking) const {
    if (i == j) return false;
    const SphereRow &a = rows_.spheres[i], &b = rows_.spheres[j];
    const bool same = a.object == b.object;
    const std::size_t bit = j - std::min(j, std::size_t(a.first));
    if (same && (rows_.meets[i * std::size_t(rows_.words) + bit / 32] >> (bit % 32) & 1u) != 0) return false;
    if (blocking != kPerObject || same)
      return nearer(glm::distance(p, b.center), j, glm::distance(p, a.center), i);
    return nearer(glm::distance(p, rows_.objects[b.object].center), b.object,
                  glm::distance(p, rows_.objects[a.object].center), a.object);
  }
  glm::vec3 average(const sh::ShRgb& sent, const spheres::SeenSphere& seen) const {
    const float at = sh::logBlockerCoordinate(seen.sin_half_angle) * float(kLogEntries - 1);
    const auto below = std::min(std::size_t(at), std::size_t(kLogEntries - 2));
    const glm::vec4 w = glm::mix(averages_[below], averages_[below + 1], at - float(below));
    const sh::Sh y = sh::evaluate(4, -seen.direction);
    glm::vec3 sum(0.0f);
    for (int l = 0; l < 4; ++l) {
      for (int c = l * l; c < (l + 1) * (l + 1); ++c) sum += w[l] * y[c] * sent[c];
    }
    return glm::max(sum, glm::vec3(0.0f));
  }

  Rows rows_;
  sh::ShRgb light_;
  sh::LogBlockerTable logs_;
  std::vector<glm::vec4> averages_;
  std::vector<sh::ShRgb> sent_, glow_;
};

}  // namespace gloam::spherical_lights
