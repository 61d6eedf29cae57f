// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8, "optimal": least squares over sums of blockers' logs, against exp(M_f) 1. OL as in Ren et al. 2006: a and b at
// each norm, from all sums brought to that norm. HYB: not the fit of the unsquared core, whose small errors 2^p-fold
// squaring turns into great ones where much is visible, but of the final result after p squarings at each sum's own
// norm, by Levenberg and Marquardt: about half the error where many spheres block.
#include "math/sh_exp_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "math/sh_blockers.h"
#include "math/sh_constants.h"

namespace gloam::sh {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint32_t kSeed = 99;  // the figures in docs/sh.md come from other sets
constexpr int kSets = 16;

struct Sample {
  Sh rest, want;
  float mean, norm;
};

std::vector<Sample> makeSamples(int order) {
  std::vector<Sample> samples;
  const LogBlockerTable table = makeLogBlockerTable(order);
  for (const Arrangement arrangement : {Arrangement::kScattered, Arrangement::kBody})
    for (const int blockers : {1, 2, 4, 8, 16, 26, 40})
      for (const auto& set : randomBlockers(arrangement, blockers, kSets, kSeed)) {
        Sample sample{sumOfLogs(table, set), {}, 0.0f, 0.0f};
        sample.want = expNumeric(sample.rest);
        sample.mean = sample.rest[0] / kShZonal0;
        sample.rest[0] = 0.0f;
        sample.norm = std::sqrt(dot(sample.rest, sample.rest));
        samples.push_back(std::move(sample));
      }
  return samples;
}

Sh approximate(const Sample& sample, const ExpCore& core) {
  const float shortening = expShortening(sample.norm);
  const int squarings = expSquarings(sample.norm * shortening, core.range);
  const float scale = std::ldexp(shortening, -squarings), x = sample.norm * scale;
  Sh scaled = sample.rest;
  scaled *= scale;
  const Sh squared = core.quadratic ? square(scaled) : Sh(scaled.order);
  const auto coreAt = [&](float part) {
    Sh h = squared;
    h *= core.c(part * x) * part * part;
    Sh linear = scaled;
    linear *= core.b(part * x) * part;
    h += linear;
    h[0] += core.a(part * x) * kShZonal0;
    return h;
  };
  Sh h = coreAt(1.0f);
  if (const float blend = core.quadratic ? expBlend(x, core.range) : 0.0f; blend > 0.0f) {
    Sh halved = square(coreAt(0.5f));
    h *= 1.0f - blend;
    halved *= blend;
    h += halved;
  }
  h *= std::exp(sample.mean * scale);
  for (int i = 0; i < squarings; ++i) h = square(h);
  return h;
}

ExpCore coreOf(const VectorXd& p, bool quadratic, float range) {
  const auto at = [&](Eigen::Index i) { return i < p.size() ? static_cast<float>(p[i]) : 0.0f; };
  return {quadratic, range, at(0), at(1), at(2), at(3), at(4), at(5)};
}

VectorXd residuals(const std::vector<Sample>& samples, const ExpCore& core) {
  const int size = samples.front().rest.size();
  VectorXd all(static_cast<Eigen::Index>(samples.size()) * size);
  Eigen::Index at = 0;
  for (const Sample& sample : samples) {
    const Sh got = approximate(sample, core);
    for (int i = 0; i < size; ++i) {
      const double difference = static_cast<double>(got[i]) - sample.want[i];
      all[at++] = std::abs(difference) < 10.0 ? difference : 10.0;  // also where a trial step overflows
    }
  }
  return all;
}

}  // namespace

ExpCore fitExpCore(int order, bool quadratic, float range) {
  const std::vector<Sample> samples = makeSamples(order);
  VectorXd p = VectorXd::Zero(quadratic ? 6 : 4);
  const auto residualsOf = [&](const VectorXd& q) { return residuals(samples, coreOf(q, quadratic, range)); };
  VectorXd r = residualsOf(p);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 40; ++iteration) {
    MatrixXd slopes(r.size(), p.size());
    for (Eigen::Index j = 0; j < p.size(); ++j) {
      VectorXd q = p;
      q[j] += 1e-3;
      slopes.col(j) = (residualsOf(q) - r) / 1e-3;
    }
    const MatrixXd normal = slopes.transpose() * slopes;
    bool better = false;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const VectorXd q = p - damped.ldlt().solve(slopes.transpose() * r);
      const VectorXd s = residualsOf(q);
      better = s.norm() < r.norm() * (1.0 - 1e-6);
      damping *= better ? 0.3 : 5.0;
      if (better) p = q, r = s;
    }
    if (!better) break;
  }
  return coreOf(p, quadratic, range);
}

ExpLinearTable fitExpLinear(int order, int entries, double step) {
  const std::vector<Sample> samples = makeSamples(order);
  ExpLinearTable table{{1.0}, {1.0}};
  for (int entry = 1; entry < entries; ++entry) {
    const double norm = entry * step;
    double a = 0.0, b = 0.0;
    for (const Sample& sample : samples) {
      Sh scaled = sample.rest;
      scaled *= static_cast<float>(norm / sample.norm);
      const Sh want = expNumeric(scaled);
      a += want[0] / kShZonal0;
      b += dot(scaled, want) / (norm * norm);
    }
    table.a.push_back(a / static_cast<double>(samples.size()));
    table.b.push_back(b / static_cast<double>(samples.size()));
  }
  return table;
}

std::string expTablesText() {
  std::string text =
      "// gloam - real-time soft global illumination\n"
      "// SPDX-License-Identifier: MIT\n"
      "//\n"
      "// SH-8: coefficients of the exponentials, for C++ and GLSL. Written by sh_fit_exp: least squares "
      "over the logs\n"
      "// of 224 sets of 1 to 40 spheres an order (sh_exp_fit.cpp says how); do not edit.\n"
      "// clang-format off\n"
      "#ifndef GLOAM_MATH_SH_EXP_TABLES_H\n#define GLOAM_MATH_SH_EXP_TABLES_H\n"
      "#ifdef __cplusplus\nnamespace gloam::sh {\n#endif\n\n"
      "const float kShExpNorm = 32.0f;  // of f^, at most\n"
      "const int kShExpSquarings = 8;\n"
      "const float kShExpBlend = 0.75f;  // of the quadratic one's range: from where on one more squaring "
      "comes in\n\n"
      "// Range of |f^|; a2, a3, b1, b2: a = 1 + a2 x^2 + a3 x^3, b = 1 + b1 x + b2 x^2.\n";
  const auto numbers = [](const std::vector<double>& values) {
    std::string list;
    for (std::size_t i = 0; i < values.size(); ++i)
      list += fmt::format("{}{:#.6g}f", i == 0 ? "" : i % 9 == 0 ? ",\n    " : ", ", values[i]);
    return list;
  };
  for (int order = 2; order <= kMaxOrder; ++order) {
    const ExpCore c = fitExpCore(order, false, 0.25f);
    text += fmt::format("const float kShExpHybrid{}[5] = {{{}}};\n", order,
                        numbers({c.range, c.a2, c.a3, c.b1, c.b2}));
  }
  text += "\n// The same, then c1, c2: c = 1/2 + c1 x + c2 x^2.\n";
  for (int order = 2; order <= kMaxOrder; ++order) {
    const ExpCore c = fitExpCore(order, true, order <= 4 ? 2.0f : 1.0f);
    text += fmt::format("const float kShExpQuadratic{}[7] = {{{}}};\n", order,
                        numbers({c.range, c.a2, c.a3, c.b1, c.b2, c.c1, c.c2}));
  }
  text +=
      "\n// a and b of expLinear at |f^| = 0, step, 2 step ...\n"
      "const int kShExpLinearEntries = 17;\nconst float kShExpLinearStep = 0.5f;\n";
  for (int order = 2; order <= kMaxOrder; ++order) {
    const ExpLinearTable table = fitExpLinear(order, 17, 0.5);
    text += fmt::format(
        "const float kShExpLinearA{0}[17] = {{\n    {1}}};\nconst float kShExpLinearB{0}[17] = {{\n    "
        "{2}}};\n",
        order, numbers(table.a), numbers(table.b));
  }
  return text + "\n#ifdef __cplusplus\n}  // namespace gloam::sh\n#endif\n#endif\n";
}

}  // namespace gloam::sh
