// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_blockers.h"

#include <cmath>

#include "math/quadrature.h"
#include "math/sampling.h"
#include "math/sh_constants.h"

namespace gloam::sh {
namespace {

struct Sphere {
  glm::vec3 centre;
  float radius;
};

/// The next sphere of a chain starts where the last one led; those that hold the receiver are left out.
struct Chain {
  glm::vec3 centre;
  float size;

  explicit Chain(sampling::Rng& random) {
    centre = sampling::uniformHemisphere(random.next2());
    centre *= 0.7f + 2.5f * random.next();
    size = 0.15f + 0.35f * random.next();
  }
  Sphere next(sampling::Rng& random) {
    const Sphere sphere{centre, size * (0.4f + 0.8f * random.next())};
    centre += sampling::uniformSphere(random.next2()) * (1.2f * sphere.radius);
    return sphere;
  }
};

Sphere scattered(bool close, sampling::Rng& random) {
  glm::vec3 centre = sampling::uniformHemisphere(random.next2());
  centre *= close ? 0.3f + 1.2f * random.next() : 0.5f + 3.5f * random.next();
  return {centre, 0.08f + 0.5f * random.next()};
}

}  // namespace

std::vector<std::vector<Blocker>> randomBlockers(Arrangement arrangement, int blockers, int sets,
                                                 std::uint32_t seed) {
  std::vector<std::vector<Blocker>> all;
  for (int set = 0; set < sets; ++set) {
    sampling::Rng random(seed, static_cast<std::uint32_t>(set),
                         static_cast<std::uint32_t>(2 * blockers + (arrangement == Arrangement::kBody)));
    Chain chain(random);
    std::vector<Blocker> seen;
    while (static_cast<int>(seen.size()) < blockers) {
      const Sphere sphere =
          arrangement == Arrangement::kBody ? chain.next(random) : scattered(set % 2 == 1, random);
      const float distance = glm::length(sphere.centre);
      if (sphere.radius * 1.02f < distance)
        seen.push_back({sphere.centre / distance, std::asin(sphere.radius / distance)});
    }
    all.push_back(std::move(seen));
  }
  return all;
}

Sh sumOfLogs(const LogBlockerTable& table, const std::vector<Blocker>& blockers) {
  Sh sum(table.order);
  for (const Blocker& blocker : blockers)
    sum += rotateZonal(table.at(std::sin(blocker.half_angle_rad)), blocker.direction);
  return sum;
}

Sh productOfVisibilities(int order, const std::vector<Blocker>& blockers) {
  Sh visible(order);
  visible[0] = kShZonal0;
  for (const Blocker& blocker : blockers) {
    Sh one = disc(order, blocker.direction, blocker.half_angle_rad);
    one *= -1.0f;
    one[0] += kShZonal0;
    visible = product(visible, one);
  }
  return visible;
}

SphereGrid::SphereGrid(int rings) {
  const GaussLegendre<double> rule(rings);
  for (std::size_t ring = 0; ring < rule.nodes.size(); ++ring)
    for (int column = 0; column < 2 * rings; ++column) {
      const double z = rule.nodes[ring], r = std::sqrt(1.0 - z * z);
      const double turn = std::acos(-1.0) * (column + 0.5) / rings;
      directions_.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
      weights_.push_back(static_cast<float>(rule.weights[ring] * std::acos(-1.0) / rings));
      const Sh basis = evaluate(kMaxOrder, directions_.back());
      basis_.insert(basis_.end(), basis.c.begin(), basis.c.end());
    }
}

Sh SphereGrid::projectVisibility(int order, const std::vector<Blocker>& blockers) const {
  std::array<double, kMaxCoefficients> sums{};
  std::vector<float> cosines;
  for (const Blocker& blocker : blockers) cosines.push_back(std::cos(blocker.half_angle_rad));
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    bool visible = true;
    for (std::size_t k = 0; k < blockers.size() && visible; ++k)
      visible = glm::dot(directions_[i], blockers[k].direction) < cosines[k];
    if (!visible) continue;
    for (std::size_t c = 0; c < sums.size(); ++c)
      sums[c] += static_cast<double>(weights_[i]) * basis_[i * kMaxCoefficients + c];
  }
  Sh result(order);
  for (int c = 0; c < result.size(); ++c) result[c] = static_cast<float>(sums[static_cast<std::size_t>(c)]);
  return result;
}

Sh SphereGrid::projectExponential(const Sh& f) const {
  std::array<double, kMaxCoefficients> sums{};
  const auto size = static_cast<std::size_t>(f.size());
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const float* basis = basis_.data() + i * kMaxCoefficients;
    double value = 0.0;
    for (std::size_t c = 0; c < size; ++c) value += static_cast<double>(f.c[c]) * basis[c];
    value = weights_[i] * std::exp(value);
    for (std::size_t c = 0; c < size; ++c) sums[c] += value * basis[c];
  }
  Sh result(f.order);
  for (std::size_t c = 0; c < size; ++c) result.c[c] = static_cast<float>(sums[c]);
  return result;
}

}  // namespace gloam::sh
