// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Slow, obvious twins of the kernels, for tests: every sum written out, sorted lists, no sharing.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/sh_light_parts.h"
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
  /// `light`: six bands.
  Twin(Rows rows, const sh::ShRgb& light, Average average, int blocking, int visibility)
      : rows_(std::move(rows)),
        parts_(sh::lightParts(light, 4)),
        logs_(logFit()),
        averages_(averageFit(average)) {
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
            point.sends * at(point.position, point.normal, blocking, visibility).direct / 3.14159265f;
        for (int i = 0; i < 16; ++i) lit[i] += leaving * cells[j][i];
      }
      sh::ShRgb sent(4);
      for (int c = 0; c < 3; ++c) {
        sh::Sh f(4), g(4);
        for (int i = 0; i < 16; ++i) f[i] = lit[i][c], g[i] = rows_.senders[s].albedo[i][c];
        const sh::Sh product = sh::product(f, g);
        for (int i = 0; i < 16; ++i) sent[i][c] = product[i];
      }
      sent.order = 4;
      sent_.push_back(sent);
    }
    std::vector<glm::vec3> radiance;
    for (std::size_t j = 0; j < rows_.sending_patches.size(); ++j) {
      glm::vec3 sum(0.0f);
      for (std::size_t k = 0; k < kPatchPoints; ++k) {
        const PointRow& point = rows_.points[rows_.spheres.size() * kDirections + j * kPatchPoints + k];
        sum +=
            at(point.position, point.normal, blocking, visibility).direct / 3.14159265f / float(kPatchPoints);
      }
      radiance.push_back(sum * rows_.sending_patches[j].albedo);
    }
    radiance_ = radiance;
  }
  /// As long as spheres have not turned, else what the kernel's buffer has is to be held against turned ones.
  const std::vector<sh::ShRgb>& sent() const { return sent_; }
  void turn(std::size_t sphere, const glm::mat3& world_from_shape) {
    sent_[sphere] = sh::rotate(world_from_shape, sent_[sphere]);
  }

  TwinLight at(const glm::vec3& p, const glm::vec3& n, int blocking, int visibility) const {
    TwinLight light;
    sh::Sh logs = all(p, n);
    const float sky_left = skyLeft(p, n);
    addPatches(p, n, sky_left, logs, light.indirect);
    light.direct = through(logs, n) * sky_left;
    for (std::size_t i = 0; i < rows_.spheres.size(); ++i) {
      const spheres::SeenSphere seen = see(p, n, i);
      if (!(seen.sin_half_angle > 0.0f)) continue;
      sh::Sh before(4);
      for (std::size_t j = 0; j < rows_.spheres.size(); ++j) {
        if (blocks(p, j, i, blocking)) before += logOf(p, n, j);
      }
      const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(4), n);
      float share = 0.0f;
      const sh::Sh disc = sh::disc(4, seen.direction, std::asin(seen.sin_half_angle));
      if (visibility == kMean) {
        const float mean = sh::dot(before, disc) / (disc[0] * sh::zonalFactor(0));
        share = std::exp(std::min(0.0f, mean)) * 3.14159265f * seen.sin_half_angle * seen.sin_half_angle *
                std::max(0.0f, glm::dot(seen.direction, n));
      } else if (visibility == kDifference) {
        sh::Sh behind = before;
        behind += logOf(p, n, i);
        share = sh::dot(sh::expQuadratic(before), cosine) - sh::dot(sh::expQuadratic(behind), cosine);
      } else {
        share = sh::dot(sh::product(sh::expQuadratic(before), disc), cosine);
      }
      if (i < sent_.size()) light.indirect += std::max(0.0f, share) * average(sent_[i], seen);
      if (i < glow_.size())
        light.direct += std::max(0.0f, share) * pastPatches(p, n, rows_.spheres[i]) * average(glow_[i], seen);
    }
    return light;
  }

 private:
  spheres::SeenSphere see(const glm::vec3& p, const glm::vec3& n, std::size_t i) const {
    return spheres::seenSphere(p, n, rows_.spheres[i].center, rows_.spheres[i].radius,
                               rows_.spheres[i].bulge);
  }

  /// What rectangles leave of a ball, each alone.
  float pastPatches(const glm::vec3& p, const glm::vec3& n, const SphereRow& ball) const {
    float left = 1.0f;
    for (const PatchRow& row : rows_.blocking_patches) {
      const float from = glm::dot(p - row.center, row.normal),
                  to = glm::dot(ball.center - row.center, row.normal);
      if (from * to >= 0.0f) continue;  // both on one side
      const float t = from / (from - to);
      const glm::vec3 hit = glm::mix(p, ball.center, t) - row.center;
      float covered = glm::clamp((1.0f - t) * glm::distance(p, ball.center) / ball.radius - 1.0f, 0.0f, 1.0f);
      for (const glm::vec3& half : {row.half_u, row.half_v}) {
        const float inside = glm::length(half) - std::abs(glm::dot(hit, glm::normalize(half)));
        covered *= glm::clamp(0.5f + 0.5f * inside / (t * ball.radius), 0.0f, 1.0f);
      }
      const float own = glm::smoothstep(0.5f, 0.9f, std::abs(glm::dot(n, row.normal)));
      const float reach = kPatchOwn * std::min(glm::length(row.half_u), glm::length(row.half_v));
      left *= 1.0f - covered * (1.0f - own * (1.0f - glm::smoothstep(0.5f, 1.0f, std::abs(from) / reach)));
    }
    return left;
  }

  /// Corner by corner, as Lambert has it, in double precision.
  static glm::vec3 patchVector(const PatchRow& row, const glm::vec3& p) {
    const glm::dvec3 c = glm::dvec3(row.center) - glm::dvec3(p), u(row.half_u), v(row.half_v);
    const glm::dvec3 corners[4] = {c - u - v, c + u - v, c + u + v, c - u + v};
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 4; ++i) {
      const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % 4]);
      const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
      if (angle > 1e-6) sum += 0.5 * angle * glm::normalize(glm::cross(a, b));
    }
    const bool above = glm::dot(c, glm::dvec3(row.normal)) <= 0.0;
    return glm::vec3((glm::dot(sum, glm::dvec3(row.normal)) > 0.0) == above ? -sum : sum);
  }
  /// What closed walls leave of the sky: corners of what is above the tangent plane, each edge as Lambert has it.
  float skyLeft(const glm::vec3& p, const glm::vec3& n) const {
    double taken = 0.0;
    for (std::size_t j = 0; j < rows_.enclosed_patches; ++j) {
      const PatchRow& row = rows_.sending_patches[j];
      const glm::vec3 c = row.center - p;
      const float lift = 1e-3f * glm::length(row.half_u + row.half_v);
      if (glm::dot(c, row.normal) > -lift) continue;
      const glm::vec3 corners[4] = {c - row.half_u - row.half_v, c + row.half_u - row.half_v,
                                    c + row.half_u + row.half_v, c - row.half_u + row.half_v};
      std::vector<glm::dvec3> above;
      for (int i = 0; i < 4; ++i) {
        const glm::dvec3 a(corners[i]), b(corners[(i + 1) % 4]);
        const double from = glm::dot(a, glm::dvec3(n)) - double(lift),
                     to = glm::dot(b, glm::dvec3(n)) - double(lift);
        if (from > 0.0) above.push_back(glm::normalize(a));
        if ((from > 0.0) != (to > 0.0)) above.push_back(glm::normalize(glm::mix(a, b, from / (from - to))));
      }
      double sum = 0.0;
      for (std::size_t i = 0; i < above.size(); ++i) {
        const glm::dvec3 a = above[i], b = above[(i + 1) % above.size()], across = glm::cross(a, b);
        const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
        if (angle > 1e-9 && glm::length(across) > 1e-9)
          sum += 0.5 * angle * glm::dot(across, glm::dvec3(n)) / glm::length(across);
      }
      taken += std::abs(sum);
    }
    const float left = glm::clamp((1.0f - float(taken) / 3.14159265f) / kSkyLeft, 0.0f, 1.0f);
    return left * left * (3.0f - 2.0f * left);
  }
  static sh::Sh coneOf(const glm::vec3& toward) {
    const float size = glm::length(toward);
    return sh::disc(4, toward / size, std::asin(std::sqrt(std::min(1.0f, size / 3.14159265f))));
  }
  /// Adds patches to the logs of all spheres, and what they send.
  void addPatches(const glm::vec3& p, const glm::vec3& n, float sky_left, sh::Sh& logs,
                  glm::vec3& sent) const {
    const sh::Sh clear = sh::expQuadratic(logs), cosine = sh::rotateZonal(sh::clampedCosine(4), n);
    glm::vec3 arriving(0.0f);
    float white = 0.0f;
    sh::Sh whole = logs;
    for (std::size_t j = 0; j < rows_.sending_patches.size(); ++j) {
      const PatchRow& row = rows_.sending_patches[j];
      const glm::vec3 toward = patchVector(row, p);
      if (!(glm::dot(p - row.center, row.normal) > 0.0f) || glm::length(toward) < 1e-9f) continue;
      const sh::Sh cone = coneOf(toward);
      const float open = sh::dot(cone, clear) / (cone[0] * sh::zonalFactor(0));
      const float size = glm::length(toward), sine = std::sqrt(std::min(1.0f, size / 3.14159265f));
      const spheres::SeenSphere disc = spheres::seenSphere(glm::vec3(0.0f), n, toward / size, sine);
      const float clipped =
          3.14159265f * disc.sin_half_angle * disc.sin_half_angle * glm::dot(disc.direction, n);
      const float facing = std::max({0.0f, glm::dot(toward, n), clipped});
      const float counts = facing * std::clamp(open, 0.0f, 1.0f);
      white += counts;
      if (j < radiance_.size()) arriving += counts * radiance_[j];
    }
    for (const PatchRow& row : rows_.blocking_patches) {
      const float scale = glm::length(row.half_u + row.half_v), height = glm::dot(p - row.center, row.normal);
      const auto smooth = [](float x) {
        const float t = glm::clamp(x, 0.0f, 1.0f);
        return t * t * (3.0f - 2.0f * t);
      };
      const float own = smooth((glm::dot(n, row.normal) - 0.5f) / 0.4f), near = 0.03f * scale;
      const float lift = height > -near ? (1.0f - own) * std::max(0.0f, near - height) : 0.0f;
      const glm::vec3 toward = patchVector(row, p + lift * row.normal);
      const float size = glm::length(toward);
      if (size < 1e-9f) continue;
      const float step = height >= 0.0f ? height / scale / 0.002f : (-height / scale - 0.02f) / 0.08f;
      const float there = 1.0f + own * (smooth(step) - 1.0f);
      const spheres::SeenSphere seen = spheres::seenSphere(glm::vec3(0.0f), n, toward / size,
                                                           std::sqrt(std::min(1.0f, size / 3.14159265f)));
      const float extent = std::abs(glm::dot(row.half_u, n)) + std::abs(glm::dot(row.half_v, n));
      const float top = (glm::dot(row.center - p, n) + extent) / (extent + 1e-3f * scale);
      const auto add = [&](sh::Sh& sum, const spheres::SeenSphere& cone, float counts) {
        const sh::Sh y = sh::evaluate(4, cone.direction);
        const glm::vec4 weights = counts * there * logFitted(logs_, cone.sin_half_angle);
        for (int l = 0; l < 4; ++l) {
          for (int c = l * l; c < (l + 1) * (l + 1); ++c) sum[c] += weights[l] * y[c];
        }
      };
      add(logs, seen, smooth(top / 0.1f));
      add(whole, {std::sqrt(std::min(1.0f, size / 3.14159265f)), toward / size}, 1.0f);
    }
    const float taken =
        kPatchSlack * (sh::dot(clear, cosine) - sky_left * sh::dot(sh::expQuadratic(whole), cosine));
    if (white > 1e-9f) sent += arriving * std::min(1.0f, std::max(0.0f, taken) / white);
  }
  sh::Sh logOf(const glm::vec3& p, const glm::vec3& n, std::size_t i) const {
    const spheres::SeenSphere seen = see(p, n, i);
    sh::Sh log = sh::evaluate(4, seen.direction);
    const glm::vec4 weights = logFitted(logs_, seen.sin_half_angle);
    for (int l = 0; l < 4; ++l) {
      for (int c = l * l; c < (l + 1) * (l + 1); ++c) log[c] *= weights[l];
    }
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
    const sh::Sh open = sh::expQuadratic(logs);
    const float peak_open = glm::clamp(sh::dot(open, sh::evaluate(4, parts_.direction)), 0.0f, 1.0f);
    return glm::max(glm::vec3(0.0f), sh::irradiance(sh::product(parts_.rest, open), n)) +
           peak_open * std::max(0.0f, glm::dot(n, parts_.direction)) * parts_.peak;
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
    const glm::vec4 w = averageFitted(averages_, seen.sin_half_angle);
    const sh::Sh y = sh::evaluate(4, -seen.direction);
    glm::vec3 sum(0.0f);
    for (int l = 0; l < 4; ++l) {
      for (int c = l * l; c < (l + 1) * (l + 1); ++c) sum += w[l] * y[c] * sent[c];
    }
    return glm::max(sum, glm::vec3(0.0f));
  }

  Rows rows_;
  sh::LightParts parts_;
  LogFit logs_;
  Fit averages_;
  std::vector<sh::ShRgb> sent_, glow_;
  std::vector<glm::vec3> radiance_;
};

}  // namespace gloam::spherical_lights
