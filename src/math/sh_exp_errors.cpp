// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_exp_errors.h"

#include <fmt/format.h>

#include <cmath>

#include "math/sh_constants.h"
#include "math/sh_exp_core.h"

namespace gloam::sh {
namespace {

constexpr std::uint32_t kSeed = 7;  // other sets than those that the coefficients were fitted to
constexpr int kRings = 64;

/// Mean square over the sphere of the difference; no more than 1e6, which divergent series reach.
double meanSquare(const Sh& got, const Sh& want) {
  double sum = 0.0;
  for (int i = 0; i < want.size(); ++i)
    sum += (static_cast<double>(got[i]) - want[i]) * (static_cast<double>(got[i]) - want[i]);
  const double mean = sum / (static_cast<double>(kShZonal0) * kShZonal0);
  return mean < 1e6 ? mean : 1e6;
}

void addErrors(ExpErrorRow& row, const LogBlockerTable& table, const SphereGrid& grid,
               const std::vector<Blocker>& set) {
  const Sh log = sumOfLogs(table, set), numeric = expNumeric(log);
  const Sh visible = grid.projectVisibility(row.order, set);
  const Sh linear = expLinear(log), hybrid = expHybrid(log), quadratic = expQuadratic(log);
  const float norm = std::sqrt(dot(log, log) - log[0] * log[0]);
  row.norm += norm;
  row.hybrid_products += expSquarings(norm, hybridCore(row.order).range);
  const float range = quadraticCore(row.order).range;
  const int squarings = expSquarings(norm, range);
  const bool blended = expBlend(std::ldexp(norm, -squarings), range) > 0.0f;
  row.quadratic_products += 1 + squarings + (blended ? 1 : 0);
  row.series4 += meanSquare(expSeries(log, 4), numeric);
  row.series9 += meanSquare(expSeries(log, 9), numeric);
  row.linear += meanSquare(linear, numeric);
  row.hybrid += meanSquare(hybrid, numeric);
  row.quadratic += meanSquare(quadratic, numeric);
  row.visible_numeric += meanSquare(numeric, visible);
  row.visible_pointwise += meanSquare(grid.projectExponential(log), visible);
  row.visible_product += meanSquare(productOfVisibilities(row.order, set), visible);
  row.visible_linear += meanSquare(linear, visible);
  row.visible_hybrid += meanSquare(hybrid, visible);
  row.visible_quadratic += meanSquare(quadratic, visible);
}

void finish(ExpErrorRow& row, int sets) {
  for (double* mean : {&row.norm, &row.hybrid_products, &row.quadratic_products}) *mean /= sets;
  for (double* error : {&row.series4, &row.series9, &row.linear, &row.hybrid, &row.quadratic,
                        &row.visible_numeric, &row.visible_pointwise, &row.visible_product,
                        &row.visible_linear, &row.visible_hybrid, &row.visible_quadratic})
    *error = std::sqrt(*error / sets);
}

}  // namespace

std::vector<ExpErrorRow> expErrors(int order, const std::vector<int>& blockers, int sets,
                                   const Progress& progress) {
  const LogBlockerTable table = makeLogBlockerTable(order);
  const SphereGrid grid(kRings);
  std::vector<ExpErrorRow> rows;
  for (const Arrangement arrangement : {Arrangement::kScattered, Arrangement::kBody})
    for (const int count : blockers) {
      ExpErrorRow row{order, arrangement, count};
      for (const auto& set : randomBlockers(arrangement, count, sets, kSeed)) {
        if (progress.stopRequested()) throw Interrupted("errors of exponentials: stopped");
        addErrors(row, table, grid, set);
      }
      finish(row, sets);
      rows.push_back(row);
    }
  return rows;
}

std::vector<ExpErrorRow> expErrors(const Progress& progress) {
  std::vector<ExpErrorRow> rows;
  for (int order = 3; order <= kMaxOrder; ++order) {
    progress.report((order - 3) / 4.0, "errors of exponentials");
    const std::vector<ExpErrorRow> more = expErrors(order, {1, 4, 16, 40}, 24, progress);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

const char* arrangementName(Arrangement arrangement) {
  return arrangement == Arrangement::kBody ? "body" : "scattered";
}

std::string expErrorTable(const std::vector<ExpErrorRow>& rows) {
  std::string text = fmt::format(
      "Exponentials of blockers' summed logs: RMS error over the sphere in % of full visibility\n"
      "{:27}| against exp(M_f) 1                     | products    | against true visibility\n"
      "{:>5} {:<9} {:>4} {:>6} | {:>7} {:>7} {:>7} {:>7} {:>5} | {:>5} {:>5} | {:>7} {:>7} {:>7} {:>6} {:>6} "
      "{:>6}\n",
      "", "order", "spheres", "", "|f^|", "PS 4", "PS 9", "OL", "HYB", "quad", "HYB", "quad", "numeric",
      "points", "chain", "OL", "HYB", "quad");
  for (const ExpErrorRow& r : rows) {
    const auto percent = [](double error) {
      return error >= 10.0 ? std::string(">999") : fmt::format("{:.2f}", 100.0 * error);
    };
    text += fmt::format(
        "{:>5} {:<9} {:>4} {:>6.2f} | {:>7} {:>7} {:>7} {:>7} {:>5} | {:>5.1f} {:>5.1f} | {:>7} {:>7} {:>7} "
        "{:>6} {:>6} {:>6}\n",
        r.order, arrangementName(r.arrangement), r.blockers, r.norm, percent(r.series4), percent(r.series9),
        percent(r.linear), percent(r.hybrid), percent(r.quadratic), r.hybrid_products, r.quadratic_products,
        percent(r.visible_numeric), percent(r.visible_pointwise), percent(r.visible_product),
        percent(r.visible_linear), percent(r.visible_hybrid), percent(r.visible_quadratic));
  }
  return text;
}

}  // namespace gloam::sh
