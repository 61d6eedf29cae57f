// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 7.4: what goes to the device each frame; there in textures, here in buffers.
#include "techniques/spherical_lights/spherical_lights_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "techniques/spherical_lights/spherical_lights_tables.h"

namespace gloam::spherical_lights {

namespace {

constexpr float kPi = 3.14159265f;
// A ball is seen as the mean over half of it, which takes its bands by 2/3 and 1/4. For a disc's cosine that is undone in the first band, in the
// second to 0.6: in full, the ball's back would shine on what is near.
constexpr float kDiscBand1 = 1.5f, kDiscBand2 = 2.4f;

/// Middle of the box round an object's spheres.
glm::vec3 middleOf(std::span<const frame::Proxy> proxies) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const frame::Proxy& proxy : proxies) {
    low = glm::min(low, proxy.center - proxy.radius);
    high = glm::max(high, proxy.center + proxy.radius);
  }
  return 0.5f * (low + high);
}

SenderRow senderOf(const frame::ProxyEmission& emission) {
  SenderRow row{};
  for (int i = 0; i < 16; ++i) row.albedo[i] = (*emission.albedo)[i];
  bandRotation(emission.world_from_shape, row.turn);
  return row;
}

SentRow glowOf(const frame::ProxyEmission& emission) {
  SentRow row{};
  const sh::ShRgb turned = sh::rotate(emission.world_from_shape, *emission.glow);
  for (int i = 0; i < 16; ++i) row.at[i] = turned[i];
  return row;
}

PatchRow patchRow(const frame::Patch& patch) {
  return {patch.center, patch.half_u, patch.half_v, patch.normal, patch.albedo};
}

/// One that shines and stands in nobody's light.
void addBall(Rows& rows, const glm::vec3& center, float radius, const SentRow& glow) {
  const auto index = std::uint32_t(rows.spheres.size());
  rows.glow.resize(rows.spheres.size());
  rows.spheres.push_back({center, radius, 0.0f, 0.0f, 0u, 0u, std::uint32_t(rows.objects.size()), index, 1u});
  rows.objects.push_back({center, index, 1u, 0u, 0u});
  rows.glow.push_back(glow);
  rows.senders.push_back({});
  rows.points.resize(rows.points.size() + std::size_t(kDirections));
  rows.meets.resize(rows.meets.size() + std::size_t(rows.words), 0u);
}

}  // namespace

Rows rowsOf(std::span<const frame::Proxy> proxies, const frame::Emission& emission) {
  if (emission.proxies.size() != proxies.size() ||
      emission.points.size() != proxies.size() * std::size_t(kDirections))
    throw Error("spherical_lights", "what spheres send is not that of these spheres");
  Rows rows;
  rows.words = std::max(1, emission.words);
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    const frame::ProxyEmission& sent = emission.proxies[i];
    rows.spheres.push_back({proxies[i].center, proxies[i].radius, 1.0f, proxies[i].bulge, 0u, 0u,
                            std::uint32_t(sent.object), std::uint32_t(sent.first),
                            std::uint32_t(sent.count)});
    if (int(i) == sent.first)
      rows.objects.push_back({middleOf(proxies.subspan(i, std::size_t(sent.count))),
                              std::uint32_t(sent.first), std::uint32_t(sent.count), 0u, 0u});
    rows.senders.push_back(senderOf(sent));
    if (emission.glows) rows.glow.push_back(glowOf(sent));
  }
  for (const frame::EmissionPoint& point : emission.points)
    rows.points.push_back({point.position, point.sends, point.normal, 0.0f});
  for (const bool enclosed : {true, false}) {
    for (const frame::Patch& patch : emission.sending_patches) {
      if (patch.enclosed == enclosed) rows.sending_patches.push_back(patchRow(patch));
    }
    if (enclosed) rows.enclosed_patches = std::uint32_t(rows.sending_patches.size());
  }
  for (const frame::Patch& patch : emission.blocking_patches)
    rows.blocking_patches.push_back(patchRow(patch));
  rows.meets = emission.meets;
  return rows;
}

void listNeighbours(Rows& rows, int blocking) {
  rows.listed.clear();
  for (std::uint32_t i = 0; i < rows.spheres.size(); ++i) {
    SphereRow& row = rows.spheres[i];
    row.first_listed = std::uint32_t(rows.listed.size());
    for (std::uint32_t j = 0; j < row.count; ++j) {
      const std::uint32_t word = rows.meets[i * std::size_t(rows.words) + j / 32];
      const bool meets = (word >> (j % 32) & 1u) != 0;
      if (row.first + j != i && meets == (blocking != kPerObject)) rows.listed.push_back(row.first + j);
    }
    row.listed = std::uint32_t(rows.listed.size()) - row.first_listed;
  }
  if (blocking == kPerObject) return;
  rows.objects.clear();
  for (std::uint32_t i = 0; i < rows.spheres.size(); ++i)
    rows.objects.push_back({rows.spheres[i].center, i, 1u, 0u, 0u});
}

void addPatchPoints(Rows& rows) {
  for (const PatchRow& row : rows.sending_patches) {
    for (const glm::vec2& at : {glm::vec2(-0.5f, -0.5f), {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}})
      rows.points.push_back({row.center + at.x * row.half_u + at.y * row.half_v, 1.0f, row.normal, 0.0f});
  }
}

void addLamps(Rows& rows, std::span<const frame::LightRow> lamps, float radius, Warnings& warnings) {
  const std::size_t things = rows.spheres.size();
  int within = 0;
  for (const frame::LightRow& lamp : lamps) {
    if (lamp.kind != frame::kLightPoint) continue;
    const auto end = rows.spheres.begin() + std::ptrdiff_t(things);
    if (std::any_of(rows.spheres.begin(), end, [&](const SphereRow& sphere) {
          return glm::distance(lamp.position, sphere.center) < sphere.radius;
        })) {
      ++within;  // no order of centres tells that all of the object stands before it
      continue;
    }
    SentRow glow{};  // a ball of radiance L has the intensity L pi r^2
    glow.at[0] = lamp.intensity / (kPi * radius * radius) * sh::zonalFactor(0);
    addBall(rows, lamp.position, radius, glow);
  }
  if (within > 0)
    warnings.push_back(
        fmt::format("spherical_lights.lamp_radius: {} lamp{} within the spheres of an object, which hide {}; "
                    "with 0, shadow maps tell what gets out",
                    within, within == 1 ? " stands" : "s stand", within == 1 ? "it" : "them"));
}

void addGlowing(Rows& rows, std::span<const frame::Patch> patches) {
  for (const frame::Patch& patch : patches) {
    const float area = 4.0f * glm::length(glm::cross(patch.half_u, patch.half_v));
    if (!(area > 0.0f)) continue;
    const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(4), patch.normal);
    SentRow glow{};
    for (int i = 0; i < 9; ++i)
      glow.at[i] = patch.glow * (cosine[i] * (i == 0 ? 1.0f : i < 4 ? kDiscBand1 : kDiscBand2));
    addBall(rows, patch.center, std::sqrt(area / kPi), glow);
  }
}

void warnOfMeetingObjects(const Rows& rows, Warnings& warnings) {
  int pairs = 0;
  std::size_t first = 0, second = 0;
  for (std::size_t a = 0; a < rows.objects.size(); ++a) {
    for (std::size_t b = a + 1; b < rows.objects.size(); ++b) {
      bool meet = false;
      if (rows.spheres[rows.objects[a].first].blocks == 0.0f ||
          rows.spheres[rows.objects[b].first].blocks == 0.0f)
        continue;
      for (std::uint32_t i = 0; i < rows.objects[a].count && !meet; ++i) {
        const SphereRow& s = rows.spheres[rows.objects[a].first + i];
        for (std::uint32_t j = 0; j < rows.objects[b].count && !meet; ++j) {
          const SphereRow& t = rows.spheres[rows.objects[b].first + j];
          meet = glm::distance(s.center, t.center) < s.radius + t.radius;
        }
      }
      if (meet && pairs++ == 0) first = a, second = b;
    }
  }
  if (pairs > 0)
    warnings.push_back(
        fmt::format("spherical_lights: spheres of {} pair{} of objects meet (objects {} and {}{}): light "
                    "between those is rough",
                    pairs, pairs == 1 ? "" : "s", first, second, pairs == 1 ? "" : ", …"));
}

}  // namespace gloam::spherical_lights
